"""Outputs of a study: progress, tables, figures, a report."""
