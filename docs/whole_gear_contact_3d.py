"""The contact model beside the recorded three-dimensional one of benchmarks/gear_contact/solve.py."""

from __future__ import annotations

import json
import tomllib
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from flexspline.fea.gear.equilibrium import Equilibrium
from flexspline.fea.gear.model import GearModel
from flexspline.geometry.load import design_from
from flexspline.geometry.sized import sized_template
from flexspline.pipeline.gear.gear_curve import CARRYING_SHARE
from flexspline.pipeline.gear.gear_model import gear_model

RECORD = Path(__file__).parents[1] / "benchmarks" / "gear_contact" / "record.json"
TEETH = RECORD.parents[1] / "tooth_pair_contact.json"
BEARINGS = ("plug", "race")
CASES = (
    ("rigid plug, 5 places", "plug", 5),
    ("rigid plug, 9 places", "plug", 9),
    ("race and balls, 5 places", "race", 5),
)
"""Words, the record's curve, places along the seat of the model; 5 is what `flexspline gear` has."""
MESHES = {
    "coarse": "coarse",
    "round": "half as long round the axis",
    "along": "half as long along the meridian and through it",
}
FINEST = "along"
ON_THE_COARSE_MESH = (
    (
        "race and balls, relieved faces, as by default",
        "race, 3 slices, relieved",
        5,
    ),
    ("race and balls, straight faces", "race, 3 slices", 5),
    ("rigid plug, straight faces", "plug, 3 slices", 9),
    ("race and balls, even load; 3-D has the stretched and stressed rim", "race, stretched", 5),
)
"""Words, the record's curve, places along the seat of the model."""


@dataclass(frozen=True)
class Beside:
    """One curve of both: turns [rad] of the output, the model's at the same torques [N·m]."""

    torque_Nm: np.ndarray
    turn: np.ndarray
    own_turn: np.ndarray
    teeth: tuple[int, ...]
    own_teeth: tuple[int, ...]

    @property
    def chords(self) -> np.ndarray:
        """Stiffness from each point to the next [N·m/rad]."""
        return np.diff(self.torque_Nm) / np.diff(self.turn)

    @property
    def own_chords(self) -> np.ndarray:
        return np.diff(self.torque_Nm) / np.diff(self.own_turn)


def record() -> dict[str, Any]:
    """As benchmarks/gear_contact/solve.py wrote it."""
    return json.loads(RECORD.read_text(encoding="utf-8"))


@cache
def model_of(
    size: float, ratio: int, changed: tuple[tuple[str, float], ...], curve: str, places: int
) -> GearModel:
    """The contact model of a sized gear with what a curve of the record has; its circular spline is rigid."""
    design = design_from(tomllib.loads(sized_template("cup", size, ratio))).changed(dict(changed))
    straight = curve.endswith("slices")
    if straight:
        design = design.changed({"gear.tooth_face": "straight"})
    face = 3 if straight or curve.endswith("relieved") else 1
    found = gear_model(design, design.part("flexspline"), places, face)
    return replace(found, spline=None, race=found.race if curve.startswith("race") else None)


def beside(found: dict[str, Any], mesh: str, curve: str, places: int) -> Beside:
    """A curve of the record, whose name begins with the bearing, and the model's."""
    points = found["meshes"][mesh]["curves"][curve]
    of = model_of(found["size"], found["ratio"], tuple(found["changed"].items()), curve, places)
    torques = [point["torque_Nm"] for point in points]
    states = [of.at_torque(torque) for torque in torques]
    return Beside(
        np.array(torques),
        np.array([point["turn_rad"] for point in points]),
        np.array([state.rotation for state in states]),
        tuple(point["teeth"] for point in points),
        tuple(teeth_of(of, state) for state in states),
    )


def teeth_of(model: GearModel, at: Equilibrium) -> int:
    """How many carry, in the whole gear."""
    force = np.abs(model.pair_forces(at))
    return round(2 * float((force > CARRYING_SHARE * force.max()).sum()) * model.teeth_per_station)


def curves_table(found: dict[str, Any]) -> str:
    """Point by point on the finest mesh."""
    lines = []
    for words, key, places in CASES:
        both = beside(found, FINEST, key, places)
        before = zip(both.chords, both.own_chords, strict=True)
        stiff = [("–", "–", "–")] + [
            (f"{K / 1e3:.2f}", f"{own / 1e3:.2f}", f"{100 * (own / K - 1):+.1f}")
            for K, own in before
        ]
        for i, (theirs, own, off) in enumerate(stiff):
            turns = f"{1e3 * both.turn[i]:.3f} | {1e3 * both.own_turn[i]:.3f}"
            teeth = f"{both.teeth[i]} | {both.own_teeth[i]}"
            lines.append(
                f"| {words} | {both.torque_Nm[i]:.2f} | {turns} | {theirs} | {own} | {off} | {teeth} |"
            )
    return "\n".join(lines)


def whole_chord(points: list[dict[str, Any]]) -> float:
    """From the first point to the last [N·m/rad]."""
    first, last = points[0], points[-1]
    return (last["torque_Nm"] - first["torque_Nm"]) / (last["turn_rad"] - first["turn_rad"])


def meshes_table(found: dict[str, Any]) -> str:
    """Each mesh, with the stiffness over all of each curve."""
    lines = []
    for key, words in MESHES.items():
        mesh = found["meshes"][key]
        K = " | ".join(f"{whole_chord(mesh['curves'][b]) / 1e3:.3f}" for b in BEARINGS)
        lines.append(
            f"| {words} | {mesh['bricks']} | {mesh['unknowns']} | {mesh['seat_points']} | {K} |"
        )
    return "\n".join(lines)


def assumptions_table(found: dict[str, Any]) -> str:
    """The model beside three-dimensional curves with other faces, and with large displacements."""
    lines = []
    for words, key, places in ON_THE_COARSE_MESH:
        both = beside(found, "coarse", key, places)
        torques = ", ".join(f"{torque:.1f}" for torque in both.torque_Nm)
        off = ", ".join(f"{100 * r:+.1f}" for r in both.own_chords / both.chords - 1)
        late = 1e3 * (both.own_turn - both.turn)
        teeth = f"{both.teeth[-1]} | {both.own_teeth[-1]}"
        lines.append(f"| {words} | {torques} | {off} | {late[0]:.2f} to {late[-1]:.2f} | {teeth} |")
    return "\n".join(lines)


def surface_table(found: dict[str, Any]) -> str:
    """Chords of CalculiX' own surface contact, small and large displacements, over the least squares'."""
    small, large = (found[f"surface contact{kind}"] for kind in ("", ", nlgeom"))
    lines = []
    for first, last in pairwise(range(len(small))):
        torques = small[first]["torque_Nm"], small[last]["torque_Nm"]
        K = [
            (torques[1] - torques[0]) / (rows[last][turn] - rows[first][turn])
            for rows, turn in (
                (small, "turn_rad"),
                (small, "own_turn_rad"),
                (large, "own_turn_rad"),
            )
        ]
        cells = " | ".join(f"{one / 1e3:.2f}" for one in K)
        lines.append(f"| {torques[0]:.2f} to {torques[1]:.2f} | {cells} |")
    return "\n".join(lines)


def teeth_table() -> str:
    """Compliance of a pair of meshed teeth by NGSolve, over the model's."""
    record = json.loads(TEETH.read_text(encoding="utf-8"))
    model = record["model_mm2_N"]
    lines = []
    for row in record["pairs"]:
        flanks = "straight" if row["crown_mm"] is None else f"one crowned, {row['crown_mm']:g} mm"
        meshed = row["compliance_mm2_N"]
        lines.append(
            f"| {row['behind_mm']:.3g} | {flanks} | {row['force_N_mm']:.1f} | "
            f"{1e5 * meshed:.2f} | {1e5 * model:.2f} | {model / meshed:.2f} |"
        )
    return "\n".join(lines)
