"""Scale of noise that outliers do not move."""

SIGMA_PER_MAD = 1.4826
"""Standard deviation over median absolute deviation of a normal distribution, 1/Φ⁻¹(3/4)."""
