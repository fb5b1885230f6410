"""Catalogue stiffness K1, K2, K3: what a straight line gets wrong, and what soft wind-up gains."""
