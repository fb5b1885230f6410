"""The toothed ring of a flexspline, and the equivalent plain ring."""
