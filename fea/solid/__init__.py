"""Solid models: quadratic tetrahedra of a part's sector, from mesher to stress."""
