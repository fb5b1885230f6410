"""Measured data against the prediction: what the simulation gets wrong, and why."""
