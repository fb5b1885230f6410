"""Buckling of the flexspline's tube: recorded eigenvalues of bricks, classical limits, who has no tube."""

from __future__ import annotations

import json
from dataclasses import replace
from math import pi, sqrt
from pathlib import Path

import pytest
from example_files import EXAMPLES

from flexspline.fea.gear.tube_buckling import Tube
from flexspline.fea.types import Elastic
from flexspline.geometry.load import load_design

ROOT = Path(__file__).parents[3]
RECORD = json.loads((ROOT / "benchmarks" / "tube_buckling.json").read_text(encoding="utf-8"))
DESIGN = load_design(EXAMPLES / "xb1-40.toml")
STEEL = Elastic.of(DESIGN.material.flexspline)
LONG = Tube(radius=100.0, wall=0.5, length=300.0, material=STEEL)


@pytest.mark.parametrize("row", RECORD["cups"], ids=lambda r: f"{r['wall_mm']}x{r['length_mm']}")
def test_clamped_is_the_whole_cup_of_bricks(row: dict) -> None:
    """CalculiX' first mode of cup and ring: within 4 %, as diaphragm and ring are neither rigid nor free."""
    cup = DESIGN.changed({
        "flexspline.bolt_count": 0, "flexspline.inner_fillet_mm": 0.0, "flexspline.outer_fillet_mm": 0.0,
        "flexspline.wall_thickness_mm": row["wall_mm"], "flexspline.length_mm": row["length_mm"],
        "flexspline.diaphragm_thickness_mm": 1.5 * row["wall_mm"],
    })  # fmt: skip
    tube = Tube.between(cup.flexspline, STEEL)
    assert tube is not None
    coarse, fine = row["calculix_Nm"]
    assert coarse == pytest.approx(fine, rel=0.01)
    assert tube.torque_Nm("clamped") == pytest.approx(fine, rel=0.04)


def test_a_hinged_tube_is_the_shallow_shell_s() -> None:
    """k = 0.85 Z^(3/4) (Batdorf; NASA SP-8007, eq. 32) for long tubes: Donnell's 0.683 is 0.83."""
    Z = LONG.length**2 / (LONG.radius * LONG.wall) * sqrt(1 - STEEL.poissons_ratio**2)
    bending = STEEL.youngs_modulus_MPa * LONG.wall**3 / (12 * (1 - STEEL.poissons_ratio**2))
    per_length = 0.85 * Z**0.75 * pi**2 * bending / LONG.length**2
    torque_Nm = 2 * pi * LONG.radius**2 * per_length / 1e3
    assert LONG.torque_Nm("hinged") == pytest.approx(torque_Nm, rel=0.03)


def test_thickness_and_length_count_as_a_long_tube_s_do() -> None:
    """T ~ t^(9/4) L^(−1/2), where the ends do not count any more."""
    for ends in ("hinged", "clamped"):
        base = LONG.torque_Nm(ends)
        assert replace(LONG, wall=1.0).torque_Nm(ends) == pytest.approx(2**2.25 * base, rel=0.05)
        assert replace(LONG, length=600.0).torque_Nm(ends) == pytest.approx(
            base / sqrt(2), rel=0.05
        )


def test_ends_that_hold_more_make_it_stronger_and_tests_lie_below() -> None:
    for length in (20.0, 60.0, 300.0):
        tube = replace(LONG, length=length)
        assert tube.torque_Nm("clamped") > tube.torque_Nm("hinged")
        # γ^(3/4) of NASA SP-8007, cylinders in torsion
        assert tube.lower_edge_Nm == pytest.approx(0.67 * tube.torque_Nm("hinged"))
    assert LONG.stress_MPa(1000.0) == pytest.approx(1e6 / (2 * pi * 100**2 * 0.5))


def test_a_cup_that_is_all_ring_has_no_tube() -> None:
    f = DESIGN.flexspline
    all_ring = f.model_copy(update={"length_mm": f.diaphragm_thickness_mm + f.ring_width_mm})
    assert Tube.between(all_ring, STEEL) is None


def test_a_short_tube_yields_before_it_buckles() -> None:
    """Shear strain at buckling: 3 t/L of a plate without curvature, more than any material's elastic one."""
    short = replace(LONG, length=4 * LONG.wall)
    assert short.stress_MPa(short.lower_edge_Nm) > 0.1 * STEEL.youngs_modulus_MPa
    assert short.yields_first
    assert not LONG.yields_first
