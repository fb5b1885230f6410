"""The outer race of the flexible bearing: a ring of rectangular section that bends and tilts.

Ports: radial pressure on its outside at each place, as wide as the seat, then the balls' groove.
"""

from __future__ import annotations

import numpy as np

from flexspline.fea.axisymmetric.harmonics import Fixed, HarmonicModel
from flexspline.fea.cylindrical import AXIAL, RADIAL
from flexspline.fea.gear.condensed import Condensed, along, condensed, even
from flexspline.fea.gear.rim import fine_enough, triangulated
from flexspline.fea.types import Elastic
from flexspline.geometry.outline import Meridian, closed


def race_outline(
    outer_radius: float, thickness: float, low: float, high: float, groove: float
) -> Meridian:
    """From z = low to high [mm]; the balls touch the middle `groove` [mm] of the inside."""
    inner, middle = outer_radius - thickness, (low + high) / 2
    return closed(
        [
            ((inner, low), None),
            ((outer_radius, low), "seat"),
            ((outer_radius, high), None),
            ((inner, high), None),
            ((inner, middle + groove / 2), "groove"),
            ((inner, middle - groove / 2), None),
        ]
    )


def condensed_race(
    outline: Meridian, material: Elastic, places: np.ndarray, last: int
) -> Condensed:
    """Ports: the outside at each of `places` (z, mm), then the groove.

    Raises
    ------
    MeshingError, HarmonicError
    """
    model = HarmonicModel(fine_enough(triangulated(outline), "seat", len(places)), material)
    still = Fixed(model.on("groove")[:1], AXIAL)  # else it could drift along the axis
    ports = [*along(model, "seat", places), even(model, "groove", RADIAL)]
    return condensed(model, ports, last, loose=[still])
