"""The design and its shape: schema, checks, profiles, CAD solids, symmetry."""
