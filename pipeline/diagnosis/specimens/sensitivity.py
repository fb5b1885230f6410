"""How a specimen's compliance changes with each dimension, by the hole-free model.

As relative changes: a hole changes the stiffness, hardly how it depends on a wall.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from math import log

import numpy as np

from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError, DesignError
from flexspline.geometry.keys import lengths, with_values
from flexspline.geometry.part_name import PartName
from flexspline.pipeline.diagnosis.specimens.bench import Bench
from flexspline.pipeline.diagnosis.specimens.tolerance import general_tolerance_mm

SMALLEST_STEP = 0.05
"""Smallest step over the dimension. A tolerance can be so small that K's change would come from the mesh."""
LARGEST_DIMENSION_STEP = 0.3
"""Largest step over the dimension. A tolerance can exceed the dimension, as of a fillet; a part with a third
less is still a part."""
MOST_TOLERANCES = 5.0
"""General tolerances: nine of ten wrong dimensions are nearer by their prior, `WRONG_TOLERANCES`."""
LEAST_CHANGE = 0.02
"""A dimension matters where MOST_TOLERANCES tolerances change some specimen's compliance by this share: twice
the usual noise of one stiffness (`evidence.USUAL_NOISE`)."""
MOST_SOLVED = 24
"""Specimens whose sensitivities are solved; of more, the others' follow by a plane over the logarithms of
their dimensions, which leaves some percent of a slope."""


@dataclass(frozen=True)
class Sensitivity:
    """ln C of one part over x = ln((d + δ)/d), a quadratic through FE at three dimensions.

    `nominal_mm`, `slope`, `curvature` (n,), 0 where the specimen has not the part; `tolerance_mm` ±.
    """

    key: str
    part: PartName
    nominal_mm: np.ndarray
    tolerance_mm: float
    slope: np.ndarray
    curvature: np.ndarray

    def rows(self, chosen: np.ndarray) -> Sensitivity:
        """For some of the specimens."""
        return replace(
            self, nominal_mm=self.nominal_mm[chosen], slope=self.slope[chosen],
            curvature=self.curvature[chosen],
        )  # fmt: skip

    def log_change(self, off_mm: float) -> np.ndarray:
        """(n,) change of ln C where the dimension is `off_mm` larger than drawn."""
        x = np.log(np.maximum(1 + off_mm / self.nominal_mm, 1e-3))
        return self.slope * x + self.curvature * x**2


def sensitivities(
    bench: Bench,
    designs: Sequence[Design],
    has: np.ndarray,
    part: PartName,
    keys: Collection[str] | None,
) -> list[Sensitivity]:
    """Of every length of the part that all specimens with the part have."""
    mine = [d for d, h in zip(designs, has, strict=True) if h]
    if not mine:
        return []
    each = [lengths(d.part(part)) for d in mine]
    of_values = []
    for key in each[0]:
        if not all(key in e for e in each) or (keys is not None and key not in keys):
            continue
        nominal = np.ones(len(designs))
        nominal[has] = [e[key] for e in each]
        tolerance = general_tolerance_mm(float(nominal[has].max()), key.endswith("fillet_mm"))
        slope, curvature = np.zeros(len(designs)), np.zeros(len(designs))
        if keys is None:
            bench.context.progress.note(f"sensitivity to {key}")
        known: dict[str, tuple[float, float]] = {}
        first = _log_slope(bench, mine[0], part, key, each[0][key], tolerance)
        if (
            keys is None
            and abs(first[0]) * MOST_TOLERANCES * tolerance / each[0][key] < LEAST_CHANGE / 2
        ):
            continue  # a first look, so that a fillet does not cost two solves a specimen
        rows = np.flatnonzero(has)
        solved = rows[np.unique(np.linspace(0, len(rows) - 1, MOST_SOLVED).round().astype(int))]
        for i in (int(j) for j in solved):
            text = designs[i].model_dump_json()
            if text not in known:
                known[text] = _log_slope(bench, designs[i], part, key, float(nominal[i]), tolerance)
            slope[i], curvature[i] = known[text]
        if len(solved) < len(rows):
            logs = np.log([list(e.values()) for e in each])
            plane = np.column_stack([np.ones(len(rows)), logs - logs.mean(axis=0)])
            at = np.searchsorted(rows, solved)
            for values in (slope, curvature):
                # least squares of least norm: dimensions that do not vary get no weight
                values[rows] = plane @ np.linalg.lstsq(plane[at], values[solved], rcond=1e-6)[0]
        s = Sensitivity(key, part, nominal, tolerance, slope, curvature)
        change = max(
            np.abs(s.log_change(MOST_TOLERANCES * tolerance)).max(),
            np.abs(s.log_change(-tolerance)).max(),
        )
        if keys is not None or change > LEAST_CHANGE:
            of_values.append(s)
    return of_values


def drawn_through(
    s: Sensitivity, bench: Bench, designs: Sequence[Design], off_mm: float
) -> Sensitivity:
    """The curve drawn through FE at a deviation, slope kept; as it was where the geometry has no room.

    A quadratic through steps of a tolerance is a few percent off where a wall is wrong by a third.
    """
    curvature = s.curvature.copy()
    for i in (int(j) for j in np.flatnonzero(s.slope)):
        x = log(max(1 + off_mm / s.nominal_mm[i], 1e-3))
        try:
            there = with_values(designs[i], {s.key: float(s.nominal_mm[i]) + off_mm})
            y = log(bench.as_in_sum(there, s.part) / bench.as_in_sum(designs[i], s.part))
        except (DesignError, ComputationError):
            continue
        curvature[i] = (y - s.slope[i] * x) / x**2
    return replace(s, curvature=curvature)


def _log_slope(
    bench: Bench, design: Design, part: PartName, key: str, nominal: float, tolerance: float
) -> tuple[float, float]:
    """Slope and curvature of ln C over ln d; one-sided where the geometry has no room."""
    step = min(max(tolerance, SMALLEST_STEP * nominal), LARGEST_DIMENSION_STEP * nominal)
    points: list[tuple[float, float]] = []
    here = log(bench.as_in_sum(design, part))
    for side in (-step, step):
        try:
            there = log(bench.as_in_sum(with_values(design, {key: nominal + side}), part))
        except (DesignError, ComputationError):
            continue
        points.append((log(1 + side / nominal), there - here))
    if not points:
        return 0.0, 0.0
    if len(points) == 1:
        return points[0][1] / points[0][0], 0.0
    (x1, y1), (x2, y2) = points
    curvature = (y1 / x1 - y2 / x2) / (x1 - x2)
    return y1 / x1 - curvature * x1, curvature
