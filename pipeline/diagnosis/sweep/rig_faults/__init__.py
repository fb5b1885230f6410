"""Faults of the test rig and of its readings: late channels, backward loops, slipping clamps, jumps."""
