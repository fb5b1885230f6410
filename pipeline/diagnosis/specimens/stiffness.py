"""What FE says of every specimen: compliance, and how it changes with each dimension and the load zone.

The row's own stiffness comes from the design's model, holes included, or, where stiffnesses are given
instead of FE, from them, scaled by the ratio of the hole-free axisymmetric model. Changes with a
dimension and with the load zone always come from that model of the same meridian without holes, as
relative changes: a hole changes the stiffness, hardly how it depends on a wall.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from math import log

import numpy as np

from flexspline.fea.shortfall import settled
from flexspline.fea.types import Elastic
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError, DesignError
from flexspline.geometry.keys import lengths, with_values, without_holes
from flexspline.geometry.part import PartName
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import Specimens
from flexspline.pipeline.diagnosis.specimens.tolerance import general_tolerance_mm
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.revolved import lobes, torsion

FE_TOLERANCE = 1e-3
"""Of the hole-free model: a step below changes K by more than ten times as much."""
LOBE_TOLERANCE = 5e-3
SMALLEST_STEP = 0.05
"""Of a dimension: a tolerance can be so small a share of it that K's change would be the mesh's."""
LARGEST_STEP = 0.3
FEELS = 0.02
"""A dimension matters where five tolerances change some specimen's compliance by this share."""
MOST_SOLVED = 24
"""Specimens whose sensitivities are solved; of more, the others' follow by a plane over the logarithms of
their dimensions, which leaves some percent of a slope."""
PARTS: Mapping[str, tuple[PartName, ...]] = {
    "flexspline": ("flexspline",),
    "shaft": ("shaft",),
    "series": ("flexspline", "shaft"),
}


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


@dataclass(frozen=True)
class Compliances:
    """FE of all specimens; compliances (n,) in rad per N·m, 0 where the part is not in the row.

    Attributes
    ----------
    flexspline, shaft : of each row's parts, load case as in the sum.
    lobes_share : (n,) (C_lobes − C_uniform)/C of the flexspline, C that of the sum's load case.
    base_zone : load zone that the simulation assumes: 0 uniform, 1 lobes.
    """

    flexspline: np.ndarray
    shaft: np.ndarray
    lobes_share: np.ndarray
    base_zone: float
    sensitivities: tuple[Sensitivity, ...]
    designs: tuple[Design, ...]

    @property
    def total(self) -> np.ndarray:
        """(n,) rad per N·m."""
        return self.flexspline + self.shaft

    def rows(self, chosen: np.ndarray) -> Compliances:
        """Some of the specimens."""
        return Compliances(
            self.flexspline[chosen], self.shaft[chosen], self.lobes_share[chosen], self.base_zone,
            tuple(s.rows(chosen) for s in self.sensitivities),
            tuple(d for d, c in zip(self.designs, chosen, strict=True) if c),
        )  # fmt: skip


@dataclass(frozen=True)
class Bench:
    """Computes compliances. `K_b`, `K_e` [N·m/rad] belong to the nominal design.

    `full`: rows are solved with their holes; else K_b and K_e are scaled by the hole-free model.
    """

    context: AnalysisContext
    K_b: float
    K_e: float
    full: bool

    def compliance(self, design: Design, part: PartName) -> float:
        """Of one part of a design [rad per N·m], load case as in the sum."""
        nominal = self.K_b if part == "flexspline" else self.K_e
        mine, other = self._model(design, part), self._model(self.context.design, part)
        return mine / other / nominal

    def _model(self, design: Design, part: PartName) -> float:
        lobed = part == "flexspline" and design.solver.load_case == "lobes"
        if self.full and not lobed:
            return 1 / replace(self.context, design=design).part(part).stiffness().K_Nm_per_rad
        return self.plain(design, part, lobed)

    def plain(self, design: Design, part: PartName, lobed: bool = False) -> float:
        """Compliance [rad per N·m] of the part without holes."""
        solid = replace(self.context, design=design).part(part).context.design
        own = without_holes(solid).part(part)
        material, shape = Elastic.of(own.material), own.shape.model_dump(mode="json")
        tolerance = LOBE_TOLERANCE if lobed else FE_TOLERANCE

        def make() -> float:
            found = lobes(own, True, tolerance) if lobed else torsion(own, tolerance)
            return 1 / settled(found).K_Nm_per_rad

        inputs = {"part": part, "shape": shape, "material": asdict(material), "lobed": lobed,
                  "tolerance": tolerance}  # fmt: skip
        return float(self.context.cache.get("specimen", inputs, make)[0])


def row_designs(design: Design, specimens: Specimens) -> tuple[Design, ...]:
    """The design of every row.

    Raises
    ------
    MeasurementError : an override that makes no design; with the row's line.
    """
    found = []
    for i in range(len(specimens.specimen)):
        own = {key: float(values[i]) for key, values in specimens.overrides.items()}
        try:
            found.append(with_values(design, own))
        except DesignError as fault:
            raise MeasurementError(specimens.path, int(specimens.line[i]), str(fault)) from None
    return tuple(found)


def compliances(
    bench: Bench,
    designs: Sequence[Design],
    parts: Sequence[str],
    keys: Collection[str] | None = None,
    zones: bool = True,
) -> Compliances:
    """FE of all rows; `parts` as in the file. Equal designs are solved once.

    `keys` limits the dimensions whose sensitivity is wanted; `zones`: whether the load zone's is.
    """
    known: dict[tuple[str, str], float] = {}

    def once(what: str, design: Design, part: PartName) -> float:
        key = (what, design.model_dump_json() + part)
        if key not in known:
            lobed = what == "lobes"
            known[key] = (
                bench.compliance(design, part)
                if what == "own"
                else bench.plain(design, part, lobed)
            )
        return known[key]

    n = len(designs)
    own = {p: np.zeros(n) for p in PARTS["series"]}
    zone = np.zeros(n)
    base = 1.0 if bench.context.design.solver.load_case == "lobes" else 0.0
    for i, (design, part) in enumerate(zip(designs, parts, strict=True)):
        if n > 1:
            bench.context.progress.note(f"stiffness of specimen {i + 1} of {n}")
        for p in PARTS[part]:
            own[p][i] = once("own", design, p)
        if zones and own["flexspline"][i]:
            uniform, lobes = (
                once("plain", design, "flexspline"),
                once("lobes", design, "flexspline"),
            )
            zone[i] = (lobes - uniform) / (lobes if base else uniform)
    return Compliances(
        own["flexspline"], own["shaft"], zone, base,
        tuple(s for p in own for s in _sensitivities(bench, designs, own[p] > 0, p, keys)),
        tuple(designs),
    )  # fmt: skip


def _sensitivities(
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
    found = []
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
        if keys is None and abs(first[0]) * 5 * tolerance / each[0][key] < FEELS / 2:
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
            np.abs(s.log_change(5 * tolerance)).max(), np.abs(s.log_change(-tolerance)).max()
        )
        if keys is not None or change > FEELS:
            found.append(s)
    return found


def refined(bench: Bench, fe: Compliances, key: str, off_mm: float) -> Compliances:
    """With the curve of one dimension drawn through FE at the deviation that was found.

    A quadratic through steps of a tolerance is a few percent off where a wall is wrong by a third.
    """
    changed = []
    for s in fe.sensitivities:
        if s.key == key:
            curvature = s.curvature.copy()
            for i in (int(j) for j in np.flatnonzero(s.slope)):
                x = log(max(1 + off_mm / s.nominal_mm[i], 1e-3))
                try:
                    there = with_values(fe.designs[i], {key: float(s.nominal_mm[i]) + off_mm})
                    y = log(bench.plain(there, s.part) / bench.plain(fe.designs[i], s.part))
                except (DesignError, ComputationError):
                    continue
                curvature[i] = (y - s.slope[i] * x) / x**2
            s = replace(s, curvature=curvature)
        changed.append(s)
    return replace(fe, sensitivities=tuple(changed))


def _log_slope(
    bench: Bench, design: Design, part: PartName, key: str, nominal: float, tolerance: float
) -> tuple[float, float]:
    """Slope and curvature of ln C over ln d; one-sided where the geometry has no room."""
    step = min(max(tolerance, SMALLEST_STEP * nominal), LARGEST_STEP * nominal)
    points: list[tuple[float, float]] = []
    here = log(bench.plain(design, part))
    for side in (-step, step):
        try:
            there = log(bench.plain(with_values(design, {key: nominal + side}), part))
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
