"""Nuisance terms: flexible functions of a channel and faults of a rig, which have no cause's name."""
