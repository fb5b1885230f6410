"""The whole gear in contact: torque-angle curve, series chain, terms, torque limits, notes."""
