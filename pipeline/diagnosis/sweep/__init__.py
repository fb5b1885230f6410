"""Torque sweeps: regressors, their evidence, the race, and what follows from it. Start in diagnose.py."""
