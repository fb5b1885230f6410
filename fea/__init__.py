"""Finite elements: axisymmetric bounds and solid models."""
