"""Sets of specimens whose stiffness FE itself makes, with something wrong, or nothing.

The truth is a whole FE solve of the part as it really is; it uses no sensitivity and no formula of the
diagnosis.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

import numpy as np
from example_files import EXAMPLES
from lobe_stiffness import lobe_stiffness

from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.types import Elastic
from flexspline.geometry.design import Design
from flexspline.geometry.load import design_from, read_toml
from flexspline.pipeline.diagnosis.measurement.record import Specimens

SPECIMENS = 8
NOISE = 0.01
FE_TOLERANCE = 3e-3
"""Of K: bounds 0.3 % apart, their middle far nearer, beside 1 % of noise in each specimen."""
Kind = Literal["clean", "softer", "joint", "lobes", "wall", "diaphragm", "length"]
MODULUS_STD = 0.02
"""As the example designs state."""
OFF_MM = {
    "wall": (-0.13, -0.16, -0.2, 0.16),
    "diaphragm": (-0.18, -0.25, 0.25),
    "length": (-2.0, 2.2),
}
"""Beyond ISO 2768-m, which allows 0.1, 0.1 and 0.2 or 0.3 mm."""
KEYS = {"wall": "wall_thickness_mm", "diaphragm": "diaphragm_thickness_mm", "length": "length_mm"}
JOINT = (0.2, 0.6)
"""A bolted joint's compliance, of the part's median."""


EXAMPLE_FILE: dict[str, np.ndarray] = {
    "flexspline.length_mm": np.array([30.0, 24, 36, 33, 27, 39, 30, 34]),
    "flexspline.wall_thickness_mm": np.array([0.40, 0.45, 0.50, 0.40, 0.52, 0.45, 0.48, 0.42]),
    "flexspline.diaphragm_thickness_mm": np.array([0.6, 0.8, 0.6, 0.9, 0.5, 0.7, 0.75, 0.55]),
}
"""Drawings of examples/measured/xb1-40-specimens.csv: what FE says of them is kept in the suite's cache."""
AS_IN_THE_EXAMPLE = -1
"""Instead of a seed."""


@dataclass(frozen=True)
class Batch:
    """A design and the drawings of its specimens: values (SPECIMENS,) by dotted key."""

    design: Design
    drawn: dict[str, np.ndarray]


@cache
def batch(name: str, seed: int) -> Batch:
    """Length, wall and diaphragm vary, at random or as in the example file.

    The part has no holes, so that FE takes 0.1 s.
    """
    tables = read_toml(EXAMPLES / f"{name}.toml")
    for part in ("flexspline", "shaft"):
        tables[part]["bolt_count"] = 0
    design = design_from(tables)
    if seed == AS_IN_THE_EXAMPLE:
        return Batch(design, EXAMPLE_FILE)
    rng = np.random.default_rng(seed)
    f = design.flexspline
    drawn = {
        "flexspline.length_mm": (f.length_mm * rng.uniform(0.8, 1.35, SPECIMENS)).round(1),
        "flexspline.wall_thickness_mm": (f.wall_thickness_mm * rng.uniform(0.95, 1.3, SPECIMENS)).round(2),
        "flexspline.diaphragm_thickness_mm": (
            f.diaphragm_thickness_mm * rng.uniform(0.85, 1.6, SPECIMENS)
        ).round(2),
    }  # fmt: skip
    drawn["flexspline.wall_thickness_mm"] = np.minimum(
        drawn["flexspline.wall_thickness_mm"], f.ring_thickness_mm - 0.01
    )
    return Batch(design, drawn)


@cache
def compliance(name: str, seed: int, kind: Kind, off_mm: float = 0.0) -> np.ndarray:
    """(SPECIMENS,) rad per N·m by FE, with a dimension off its drawing, or loaded at the lobes."""
    made = batch(name, seed)
    found = []
    for i in range(SPECIMENS):
        tables = made.design.tables
        for key, values in made.drawn.items():
            tables["flexspline"][key.partition(".")[2]] = float(values[i])
        if off_mm:
            tables["flexspline"][KEYS[kind]] += off_mm
            rim = tables["flexspline"]
            # the ring's root stays where it was drawn, unless a thicker wall has reached it
            rim["ring_thickness_mm"] = max(
                rim["ring_thickness_mm"], rim["wall_thickness_mm"] + 0.01
            )
        design = design_from(tables)
        material = Elastic.of(design.material.flexspline)
        outline = design.part("flexspline").meridian
        if kind == "lobes":
            found.append(1 / lobe_stiffness(outline, material, True, 5e-3).K_Nm_per_rad)
        else:
            found.append(
                1 / torsional_stiffness(outline, material, "mesh", FE_TOLERANCE).K_Nm_per_rad
            )
    return np.array(found)


@dataclass(frozen=True)
class Hidden:
    """What was hidden and what was measured: `cause` None for nothing, `size` in its unit."""

    kind: Kind
    cause: str | None
    size: float
    specimens: Specimens


def hidden(name: str, seed: int, kind: Kind, rng: np.random.Generator) -> Hidden:
    """A measured set; Young's modulus is off within its uncertainty where it is not the cause."""
    made = batch(name, seed)
    modulus = float(np.exp(MODULUS_STD * rng.standard_normal()))
    cause, size = None, 0.0
    if kind == "softer":
        cause, size = "youngs_modulus", float(rng.choice([-1, -1, 1]) * rng.uniform(9, 20))
        modulus = 1 + size / 100
    off = 0.0
    if kind in OFF_MM:
        off = float(rng.choice(OFF_MM[kind]))
        cause, size = f"geometry:flexspline.{KEYS[kind]}", off
    C = compliance(name, seed, kind if off or kind == "lobes" else "clean", off) / modulus
    if kind == "lobes":
        cause, size = "load_zone", 1.0
    if kind == "joint":
        nominal = compliance(name, seed, "clean")
        share = float(rng.uniform(*JOINT))
        cause, size = "series_compliance", 100 * share * float(np.median(nominal) / nominal.mean())
        C = C + share * np.median(nominal)
    K = (1 + NOISE * rng.standard_normal(SPECIMENS)) / C
    stated = NOISE * K if rng.uniform() < 0.5 else None
    names = tuple(f"S{i + 1}" for i in range(SPECIMENS))
    return Hidden(
        kind, cause, size,
        Specimens(Path("made.csv"), names, ("flexspline",) * SPECIMENS, K, stated, made.drawn,
                  np.arange(SPECIMENS) + 2),
    )  # fmt: skip
