"""Bodies of revolution: everything solved on the meridian, two-dimensional and fast."""
