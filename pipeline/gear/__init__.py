"""The whole gear in contact: torque-angle curve, chain, terms, limits, and what is to be noted."""
