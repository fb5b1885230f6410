"""The toothed ring of a flexspline, and the plain ring that is as stiff."""
