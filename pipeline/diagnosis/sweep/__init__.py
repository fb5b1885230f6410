"""Torque sweeps: regressors, their evidence, the race, and what follows from it.

Start in `diagnose.py`, which has all steps in order.

Each folder imports from those above it, and all from the files beside this one.

| folder | contents |
|---|---|
| `nuisance/` | terms without a cause's name |
| `evidence/` | rows, design matrix, fit, evidence of a set, search for the best set |
| `crossing/` | where the gap is crossed |
| `identification/` | from the best set to causes: significance, rivals, imitations |
| `race/` | comparison of sets of causes by their evidence |
| `magnitudes/` | sizes with their standard deviations |
| `residual/` | tests of what the best set leaves |
| `rig_faults/` | late readings, backward loops, slipping clamps |
"""
