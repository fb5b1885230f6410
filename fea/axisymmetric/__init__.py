"""Bodies of revolution, solved on the two-dimensional meridian."""
