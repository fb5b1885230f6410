"""What a person sees of a study: progress, tables, figures, a report."""
