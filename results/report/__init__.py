"""The PDF report: its content as data, and the typst template that sets it."""
