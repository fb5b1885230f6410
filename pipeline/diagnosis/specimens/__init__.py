"""Specimens: measured stiffness of several parts of different dimensions against FE."""
