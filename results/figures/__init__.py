"""Charts drawn with matplotlib, one per file."""
