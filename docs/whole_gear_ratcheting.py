"""Ratcheting torques of a catalogue beside the torque at which the contact model loses its teeth."""

from __future__ import annotations

import csv
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from statistics import median

import numpy as np
from whole_gear_figures import CATALOGUE, CHANGES, sized_design

from flexspline.fea.gear.engagement import Engagement
from flexspline.fea.gear.model import GearModel
from flexspline.geometry.rated import rated_torque
from flexspline.pipeline.gear.gear_model import gear_model
from flexspline.pipeline.gear.largest_torques import tube_of

PITCH_RADIUS = 1.27
"""Of a catalogue's size [mm]: half of a tenth of an inch."""
CHANGED = (
    "`gear.pressure_angle_deg` 30 for 20", "working depth 1.0 strokes for 1.34",
    "`gear.circular_spline_diameter_mm` / 1.1", "rigid circular spline",
    "`flexspline.ring_thickness_mm` × 1.2", "`flexspline.wall_thickness_mm` × 1.2",
    "`wave_generator.ball_diameter_mm` / 1.2", "`wave_generator.race_thickness_mm` × 1.2",
    "18 balls for 23", "no bearing play", "plain flanks", "conjugate flanks", "teeth three times softer",
    "straight teeth along the face",
)  # fmt: skip


@dataclass(frozen=True)
class Row:
    """One line of the catalogue [N·m], and the model's ratcheting torque."""

    size: float
    ratio: int
    ratcheting_Nm: float
    predicted_Nm: float
    buckling_Nm: float

    @property
    def over(self) -> float:
        """Predicted over catalogue."""
        return self.predicted_Nm / self.ratcheting_Nm

    @property
    def least_over(self) -> float:
        """The same, where the tube may buckle first."""
        return min(self.predicted_Nm, self.buckling_Nm) / self.ratcheting_Nm

    @property
    def per_radius_cubed(self) -> float:
        """Of the catalogue's torque [MPa]."""
        return 1e3 * self.ratcheting_Nm / (PITCH_RADIUS * self.size) ** 3


@cache
def rows() -> tuple[Row, ...]:
    """Each of the catalogue's, for the design of that size and ratio."""
    found = []
    with (CATALOGUE / "hd_ratcheting_buckling.csv").open(encoding="utf-8") as file:
        for line in csv.DictReader(row for row in file if not row.startswith("#")):
            size, ratio = float(line["size"]), int(line["ratio"])
            given = float(line["ratcheting_torque_Nm"])
            design = sized_design(size, ratio)
            model = gear_model(design, design.part("flexspline"))
            tube = tube_of(design)
            if tube is None:
                raise ValueError(f"the cup of size {size:g} has no tube")
            engaged = limit(model, rated_torque(design)[0])
            found.append(Row(size, ratio, given, engaged, tube.lower_edge_Nm))
    return tuple(found)


def limit(model: GearModel, first_Nm: float) -> float:
    """Of a gear that lets go [N·m]."""
    found = Engagement(model).limit(first_Nm)
    if found is None:
        raise ValueError("the teeth hold at any torque")
    return found


def by_ratio() -> str:
    """Medians of predicted over catalogue, and of the catalogue's torque over r_p³."""
    lines = []
    for ratio in sorted({row.ratio for row in rows()}):
        lines.append(_class(str(ratio), lambda row, ratio=ratio: row.ratio == ratio))
    return "\n".join([*lines, _class("all", lambda row: True)])


def _class(name: str, belongs: Callable[[Row], bool]) -> str:
    mine = [row for row in rows() if belongs(row)]
    over, least = [row.over for row in mine], [row.least_over for row in mine]
    scaled = [row.per_radius_cubed for row in mine]
    return (
        f"| {name} | {len(mine)} | {median(over):.1f} | {min(over):.1f} to {max(over):.1f} | "
        f"{median(least):.1f} | {min(least):.1f} to {max(least):.1f} | "
        f"{median(scaled):.1f} | {float(np.std(np.log(scaled))):.2f} |"
    )


def each() -> str:
    """Every row of the catalogue."""
    return "\n".join(
        f"| {r.size:g} | {r.ratio} | {r.ratcheting_Nm:g} | {r.predicted_Nm:.3g} | {r.over:.1f} |"
        for r in rows()
    )


def sensitivity(size: float) -> str:
    """The torque with one assumption changed over that without, ratios 100 and 30."""
    columns = [_changed(size, ratio) for ratio in (100, 30)]
    order = sorted(CHANGED, key=lambda name: -max(abs(np.log(c[name])) for c in columns))
    return "\n".join(
        f"| {name} | {' | '.join(f'{column[name]:.2f}' for column in columns)} |" for name in order
    )


def _changed(size: float, ratio: int) -> dict[str, float]:
    design, changes = sized_design(size, ratio), dict(CHANGES)
    own, first = gear_model(design, design.part("flexspline")), rated_torque(design)[0]
    base = limit(own, first)
    return {name: limit(changes[name](design, own), first) / base for name in CHANGED}
