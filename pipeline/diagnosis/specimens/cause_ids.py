"""Ids of causes that only specimens show, as in docs/contract.md."""

YOUNGS_MODULUS = "youngs_modulus"
LOAD_ZONE = "load_zone"
GEOMETRY = "geometry:"
"""Before the key of a dimension."""
