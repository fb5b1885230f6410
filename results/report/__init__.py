"""The reports: their content as data, and the templates for PDF and HTML."""
