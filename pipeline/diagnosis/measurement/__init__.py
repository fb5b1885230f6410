"""A measured file: read, checked, its noise and its torque programme."""
