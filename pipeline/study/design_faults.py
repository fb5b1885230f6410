"""Errors that concern one design of a study only; the other designs continue."""

from __future__ import annotations

from flexspline.fea.axisymmetric.patches import PatchError
from flexspline.geometry.errors import ComputationError, DesignError
from flexspline.pipeline.backlash import StiffnessValueError
from flexspline.pipeline.bearing_play import BearingPlayDomainError

DESIGN_FAULTS = (
    DesignError,
    ComputationError,
    PatchError,
    StiffnessValueError,
    BearingPlayDomainError,
)
"""They cost that design a figure, or all. A NestingError is none: no figure of the design is kept then."""
