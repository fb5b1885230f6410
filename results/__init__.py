"""Outputs: records, pictures, report, the command line."""
