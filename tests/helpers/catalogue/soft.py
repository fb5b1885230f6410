"""Soft wind-up by similar sizes: one shape for each ratio class, torque in proportion to size³."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from catalogue.table import CatalogueRow, twist_rad
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.causes.cause import Element
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import LAWS

TOP = 2.0
"""Curves are compared up to this multiple of T2, about a gear's repeated peak torque."""
POINTS = 200
"""Of a curve; the straight stiffness of a catalogue row is then within 0.04 % of many points'."""


@dataclass(frozen=True)
class SoftShape:
    """What sizes of one ratio class have in common.

    `K2_over_K1`, `K3_over_K1`, `T2_over_T1`: geometric means. `T1_per_size3` [N·m], T1/size³.
    """

    ratio_class: str
    K2_over_K1: float
    K3_over_K1: float
    T2_over_T1: float
    T1_per_size3: float
    sizes: tuple[int, ...]

    def row(self, size: int, straight_K: float, top_Nm: float) -> CatalogueRow:
        """The curve of a size whose best straight line up to `top_Nm` has stiffness `straight_K`."""
        T1 = self.T1_per_size3 * size**3
        unit = CatalogueRow(
            size, self.ratio_class, T1, T1 * self.T2_over_T1,
            (1.0, self.K2_over_K1, self.K3_over_K1), (0.0, 0.0, 0.0),
        )  # fmt: skip
        scale = straight_K / straight_stiffness(unit, top_Nm)
        return replace(unit, K=(scale, scale * self.K2_over_K1, scale * self.K3_over_K1))


def soft_shape(rows: Sequence[CatalogueRow]) -> SoftShape:
    """Of rows of one ratio class."""

    def mean(values: Sequence[float]) -> float:
        return float(np.exp(np.mean(np.log(values))))

    return SoftShape(
        rows[0].ratio_class,
        mean([r.K[1] / r.K[0] for r in rows]),
        mean([r.K[2] / r.K[0] for r in rows]),
        mean([r.T2 / r.T1 for r in rows]),
        mean([r.T1 / r.size**3 for r in rows]),
        tuple(r.size for r in rows),
    )


def torques(top_Nm: float) -> np.ndarray:
    """(POINTS,) torques from 0 to the top [N·m]."""
    return np.linspace(0, top_Nm, POINTS)


def straight_stiffness(row: CatalogueRow, top_Nm: float) -> float:
    """K [N·m/rad] of the straight line through 0 that is nearest to the twist up to the top.

    No simulation with one K can do better on this row.
    """
    T = torques(top_Nm)
    return float(T @ T / (T @ twist_rad(row, T)))


def hardening_elements(row: CatalogueRow, top_Nm: float) -> tuple[Element, ...]:
    """The row as elements of `stiffness_hardening` beside a straight line of K3: a knee at T1, one at T2.

    θ = T/K3 + (1/K1 − 1/K2)·min(T, T1) + (1/K2 − 1/K3)·min(T, T2); amplitudes in arcsec.
    """
    K1, K2, K3 = row.K
    steps = ((row.T1, row.T1 * (1 / K1 - 1 / K2)), (row.T2, row.T2 * (1 / K2 - 1 / K3)))
    return tuple(
        Element(
            {"law": LAWS["knee"], "parameter": T / top_Nm, "held": 0, "largest_torque_Nm": top_Nm},
            (ARCSEC_PER_RAD * extra,),
        )
        for T, extra in steps
    )
