"""Lift-off of a part with bolt holes: its interval from two bodies of revolution, against tetrahedra.

The tetrahedra have the holes, and a contact of their own (tests/helpers/seat_in_3d.py). What a coarse mesh
does to K it does to K held alike, so their ratio is compared; without holes, with the harmonics'.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from example_files import EXAMPLES
from seat_in_3d import rim_in_3d

from flexspline.geometry.load import load_design
from flexspline.geometry.nested import nested_bodies
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.load_cases import rim_stiffness
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.revolved import contact, lobes

CUP = load_design(EXAMPLES / "xb1-40.toml")
PARTS = {
    "six large holes": {
        "bolt_count": 6, "bolt_hole_diameter_mm": 4.4, "diaphragm_thickness_mm": 1.5,
    },
    "four large holes in a short thick cup": {
        "bolt_count": 4, "bolt_hole_diameter_mm": 4.4, "wall_thickness_mm": 2.0,
        "ring_thickness_mm": 2.0, "length_mm": 14.0, "diaphragm_thickness_mm": 2.0,
        "boss_thickness_mm": 2.0,
    },
}  # fmt: skip
"""Bodies 4 and 15 % apart with lift-off."""
RATIO_KNOWN = 0.003
"""Of the ratio on coarse tetrahedra against harmonics, whose doubt is 0.001 to 0.002: 0.0006 to 0.0016 were
seen."""


@pytest.mark.long
def test_tetrahedra_and_harmonics_agree_on_a_body_of_revolution() -> None:
    whole = nested_bodies(CUP.part("flexspline")).whole
    found = rim_in_3d(whole, repeats=6, coarser=2.0)
    ratio = contact(whole, 0.002).K_Nm_per_rad / lobes(whole, True, 0.002).K_Nm_per_rad
    assert found.ratio == pytest.approx(ratio, abs=RATIO_KNOWN)
    assert found.free < found.resting < found.held


@pytest.mark.long
@pytest.mark.parametrize("case", PARTS)
def test_the_interval_holds_what_the_drawn_holes_give(case: str, tmp_path: Path, record) -> None:
    changes = {f"flexspline.{key}": value for key, value in PARTS[case].items()}
    design = CUP.changed(changes | {"solver.tolerance_pct": 2.0})
    model = AnalysisContext(design, Cache(tmp_path), Progress()).part("flexspline")
    held, resting = (rim_stiffness(model, case) for case in ("lobes", "lobes_contact"))
    assert model.part.bolts is not None
    drawn = rim_in_3d(model.part, model.part.bolts.count, coarser=3.0)
    truth = held.K_Nm_per_rad * drawn.ratio
    record(
        f"K_b, lobes, rim may lift off, {case}", "tetrahedra with the holes and the contact drawn",
        truth, resting.K_Nm_per_rad, "N·m/rad",
    )  # fmt: skip
    assert not resting.guaranteed
    assert resting.lower_Nm_per_rad < truth < resting.upper_Nm_per_rad
