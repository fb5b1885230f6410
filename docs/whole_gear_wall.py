"""The tube's wall that a catalogue's buckling torques ask for, and the closed form beside CalculiX."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

from scipy.optimize import brentq
from whole_gear_figures import CATALOGUE, sized_design

from flexspline.fea.gear.tube_buckling import LOWER_EDGE_OF_TESTS, EndFixity, Tube
from flexspline.geometry.sized import PITCH_RADIUS_PER_SIZE_mm
from flexspline.pipeline.gear.largest_torques import tube_of

RECORD = Path(__file__).parents[1] / "benchmarks" / "tube_buckling.json"
RATIO = 100
"""A size has one buckling torque at all ratios."""
THINNEST, THICKEST = 1e-3, 0.1
"""Of the pitch radius."""


def buckling_torques() -> dict[float, float]:
    """Of each size [N·m].

    Raises
    ------
    ValueError : a size has two.
    """
    found: dict[float, float] = {}
    with (CATALOGUE / "hd_ratcheting_buckling.csv").open(encoding="utf-8") as file:
        for line in csv.DictReader(row for row in file if not row.startswith("#")):
            size, torque = float(line["size"]), float(line["buckling_torque_Nm"])
            if found.setdefault(size, torque) != torque:
                raise ValueError(f"size {size:g} has two buckling torques")
    return found


def wall_share(tube: Tube, torque_Nm: float, pitch_radius: float, ends: EndFixity) -> float:
    """Of the pitch radius: the wall of a perfect tube that buckles at that torque."""

    def excess(share: float) -> float:
        return replace(tube, wall=share * pitch_radius).torque_Nm(ends) - torque_Nm

    return float(brentq(excess, THINNEST, THICKEST))


def catalogue_table() -> str:
    """Size by size: the torque, over r_p³, and the wall by the lower edge of tests and by theory."""
    lines = []
    for size, torque in buckling_torques().items():
        tube = tube_of(sized_design(size, RATIO))
        if tube is None:
            raise ValueError(f"the cup of size {size:g} has no tube")
        radius = PITCH_RADIUS_PER_SIZE_mm * size
        walls = [
            wall_share(tube, torque / LOWER_EDGE_OF_TESTS, radius, "hinged"),
            wall_share(tube, torque, radius, "clamped"),
        ]
        lines.append(
            f"| {size:g} | {torque:g} | {1e3 * torque / radius**3:.1f} | {walls[0]:.4f} | {walls[1]:.4f} |"
        )
    return "\n".join(lines)


def calculix_table() -> str:
    """The closed form beside linear buckling of bricks."""
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    return "\n".join(
        f"| {r['wall_mm']:g} | {r['length_mm']:g} | {r['hinged_Nm']:.0f} | {r['clamped_Nm']:.0f} | "
        f"{' | '.join(f'{x:.0f}' for x in r['calculix_Nm'])} |"
        for r in record["cups"]
    )
