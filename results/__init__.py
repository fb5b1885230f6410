"""What a person sees and keeps: records, pictures, report, the command line."""
