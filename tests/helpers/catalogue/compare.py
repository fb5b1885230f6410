"""Straight line against soft wind-up on sizes left out, and what a line books as clearance."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from catalogue.soft import (
    TOP,
    SoftShape,
    soft_shape,
    straight_stiffness,
    torques,
)
from catalogue.table import (
    CatalogueRow,
    read_catalogue,
    twist_rad,
)
from flexspline.geometry.rated import LOST_MOTION_SHARE
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.left_out import LeftOut
from flexspline.pipeline.diagnosis.outcome import Gain
from flexspline.pipeline.diagnosis.robust import rms


@dataclass(frozen=True)
class RowComparison:
    """One size, predicted with the shape of the other sizes and its own best straight K alone.

    Attributes
    ----------
    straight_K : [N·m/rad]. soft : the predicted curve.
    line_pct, soft_pct : rms error of twist up to TOP·T2, of the rms twist.
    floor_pct : what rounding of the printed K leaves.
    low_torque_pct : by how much the straight line is too stiff below T1.
    booked_arcmin : gap that a line with the stiffness K3, fitted above T2, leaves at T = 0.
    limit_arcmin : lost motion that the maker allows, None where the catalogue gives none.
    """

    row: CatalogueRow
    straight_K: float
    soft: CatalogueRow
    line_pct: float
    soft_pct: float
    floor_pct: float
    low_torque_pct: float
    booked_arcmin: float
    limit_arcmin: float | None

    @property
    def refuted(self) -> bool:
        """Whether such a gap alone would be more than all lost motion: clearance shows at any torque."""
        return self.limit_arcmin is not None and self.booked_arcmin > self.limit_arcmin


@dataclass(frozen=True)
class LostMotion:
    """Elastic wind-up 2·share·T_N/K1 of a size [arcmin]."""

    size: int
    rated_Nm: float
    K1: float
    windup_arcmin: float


@dataclass(frozen=True)
class CatalogueFinding:
    """All comparisons; `shapes` from all sizes; `gain` on sizes left out, in % of twist."""

    rows: tuple[RowComparison, ...]
    shapes: tuple[SoftShape, ...]
    gain: Gain
    lost_motion: tuple[LostMotion, ...]


def compare(folder: Path, share: float = LOST_MOTION_SHARE) -> CatalogueFinding:
    """Read the catalogue files of `examples/catalogue` and compare; each size left out in turn.

    Raises
    ------
    MeasurementError : a row that is not numbers.
    """
    rows = read_catalogue(folder / "hd_torsional_stiffness.csv")
    limits = _limits(folder / "hd_accuracy_limits_CHA.csv")
    compared = tuple(_compared(row, rows, limits.get((row.size, row.ratio_class))) for row in rows)
    classes = tuple(dict.fromkeys(r.ratio_class for r in rows))
    sizes = sorted({r.size for r in rows})
    gain = Gain(
        LeftOut("size", each=len(sizes)),
        rms([c.line_pct for c in compared]),
        rms([c.line_pct for c in compared]),
        rms([c.soft_pct for c in compared]),
        rms([c.floor_pct for c in compared]),
        "%",
        tuple(range(len(rows))),
    )
    return CatalogueFinding(
        compared,
        tuple(soft_shape([r for r in rows if r.ratio_class == c]) for c in classes),
        gain,
        lost_motion(folder / "schaeffler_TPI275_RT1-H-CS_i100.csv", share),
    )


def _limits(path: Path) -> dict[tuple[int, str], float]:
    """Lost motion allowed [arcmin] by size and ratio class."""
    with path.open(encoding="utf-8", newline="") as file:
        return {
            (int(r["size"]), r["ratio_class"]): float(r["lost_motion_arcmin_max"])
            for r in csv.DictReader(file)
        }


def _compared(
    row: CatalogueRow, rows: Sequence[CatalogueRow], limit_arcmin: float | None
) -> RowComparison:
    shape = soft_shape([r for r in rows if r.ratio_class == row.ratio_class and r.size != row.size])
    top = TOP * row.T2
    K = straight_stiffness(row, top)
    soft = shape.row(row.size, K, top)
    T = torques(top)
    true = twist_rad(row, T)
    rounding = 0.0
    for i, step in enumerate(row.printed):
        other = list(row.K)
        other[i] += step / 12**0.5  # standard deviation of a value rounded to `step`
        moved = replace(row, K=(other[0], other[1], other[2]))
        moved_K = straight_stiffness(moved, top)
        # both sides know the straight stiffness, so only the shape's rounding counts
        rounding += _share(twist_rad(moved, T) * moved_K / K, true) ** 2
    K1, K2, K3 = row.K
    intercept = row.T1 / K1 + (row.T2 - row.T1) / K2 - row.T2 / K3
    return RowComparison(
        row, K, soft, _share(T / K, true), _share(twist_rad(soft, T), true), rounding**0.5,
        100 * (K / K1 - 1), 2 * intercept * ARCSEC_PER_RAD / 60, limit_arcmin,
    )  # fmt: skip


def lost_motion(path: Path, share: float = LOST_MOTION_SHARE) -> tuple[LostMotion, ...]:
    """Elastic part of lost motion, twist between ± a share of rated torque."""
    with path.open(encoding="utf-8", newline="") as file:
        lines = list(csv.DictReader(file))
    found = []
    for line in lines:
        rated, K1 = float(line["T_N_Nm"]), float(line["K1_Nm_per_rad"])
        windup = 2 * share * rated / K1 * ARCSEC_PER_RAD / 60
        found.append(LostMotion(int(line["size"]), rated, K1, windup))
    return tuple(found)


def _share(curve: np.ndarray, true: np.ndarray) -> float:
    """Rms difference in % of the rms of the true curve."""
    return 100 * rms(curve - true) / rms(true)
