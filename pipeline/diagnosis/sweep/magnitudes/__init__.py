"""Magnitudes of the named causes and of the calibration, with their standard deviations."""
