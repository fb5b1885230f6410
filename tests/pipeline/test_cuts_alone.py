"""Where meshes need only tell what bolt holes change, and what happens where that fails."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from pathlib import Path
from typing import Any

import pytest
from example_files import EXAMPLES

from flexspline.fea.axisymmetric.meridian_mesh import MeshingError
from flexspline.fea.errors import MeshQualityError
from flexspline.fea.solid import torsion_field
from flexspline.fea.types import Stiffness
from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design
from flexspline.pipeline import solid_torsion
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.lobes_with_holes import lobes_with_holes
from flexspline.pipeline.parts import AnalysisContext, PartModel
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.solid_lobes import solid_lobes

CUP = load_design(EXAMPLES / "xb1-40.toml").changed({"solver.tolerance_pct": 1.0})
KEYED = load_design(EXAMPLES / "keyed-shaft.toml").changed({"solver.tolerance_pct": 1.0})
WIDE = CUP.changed(
    {"flexspline.bolt_hole_diameter_mm": 4.4, "flexspline.diaphragm_thickness_mm": 1.5}
)
"""Large holes that leave 0.3 mm of the boss beside them: the two bodies are 5 % apart."""
ALONE = "superposition"


def shaft(folder: Path, design: Design = CUP) -> PartModel:
    return AnalysisContext(design, Cache(folder), Progress()).part("shaft")


def of_all_the_field(folder: Path, design: Design = CUP) -> Stiffness:
    by_name = design.changed({"solver.model": "solid"})
    return solid_torsion.twisted(shaft(folder, by_name), 0.01).stiffness


@pytest.mark.parametrize("design", [CUP, KEYED], ids=["holes", "keyway"])
def test_a_shaft_is_known_better_by_the_same_mesh(
    design: Design, suite_cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(solid_torsion, "COARSE_TOLERANCE", inf)  # else its first mesh is coarser
    found = solid_torsion.twisted(shaft(suite_cache, design), 0.01).stiffness
    whole = of_all_the_field(suite_cache, design)
    assert ALONE in found.method
    assert ALONE not in whole.method
    assert found.levels[0].elements == whole.levels[0].elements
    first = found.levels[0]
    assert first.K_check_Nm_per_rad == pytest.approx(first.K_Nm_per_rad, rel=1e-6)  # by the work
    assert found.half_width < whole.half_width / 3
    assert whole.lower_Nm_per_rad < found.lower_Nm_per_rad
    assert found.upper_Nm_per_rad < whole.upper_Nm_per_rad


def test_holes_that_open_into_the_keyway_are_solved_with_all_of_the_field(tmp_path: Path) -> None:
    """What the body without them passes from hole to slot is on no wall: K was 1.5 to 3.6 % high."""
    design = KEYED.changed(
        {
            "shaft.bolt_count": 2, "shaft.bolt_circle_diameter_mm": 12.0,
            "shaft.bolt_hole_diameter_mm": 2.0, "shaft.segment[0].length_mm": 16.0,
            "shaft.keyway.length_mm": 33.0, "solver.tolerance_pct": 5.0,
        }
    )  # fmt: skip
    model = shaft(tmp_path, design)
    assert model.part.cuts_meet
    assert ALONE not in solid_torsion.twisted(model, 0.05).stiffness.method


@pytest.mark.parametrize("fault", ["wall", "none", "contradiction", "little"])
def test_where_it_fails_all_of_the_field_is_solved(
    fault: str, tmp_path: Path, suite_cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    solve = torsion_field.torsion_and_correction

    def fails(*given: Any) -> Any:
        solved, correction = solve(*given)
        if fault == "wall":
            raise MeshingError("a place is not on the meridian")
        if fault == "none":
            raise MeshQualityError("no walls")
        share = -0.5 if fault == "contradiction" else 0.95  # of K without holes, in N·mm
        return solved, replace(correction, lost=share * 1000 * solved.K_energy)

    monkeypatch.setattr(torsion_field, "torsion_and_correction", fails)
    found = solid_torsion.twisted(shaft(tmp_path), 0.01).stiffness
    monkeypatch.undo()
    assert ALONE not in found.method
    whole = of_all_the_field(suite_cache)
    assert found.bounds_Nm_per_rad == pytest.approx(whole.bounds_Nm_per_rad, rel=1e-6)


@pytest.mark.parametrize("supported", [True, False])
def test_under_the_lobes_it_lies_within_what_all_of_the_field_says(
    supported: bool, suite_cache: Path
) -> None:
    part, alone = (
        AnalysisContext(design, Cache(suite_cache), Progress()).part("flexspline")
        for design in (WIDE, WIDE.changed({"solver.model": "solid"}))
    )
    found, whole = lobes_with_holes(part, supported), solid_lobes(alone, supported)
    assert ALONE in found.method
    assert not found.guaranteed
    assert found.half_width < 0.01
    assert (
        found.half_width < whole.half_width / 2
    )  # most is K without holes, to 0.3 of the tolerance
    assert whole.lower_Nm_per_rad < found.K_Nm_per_rad < whole.upper_Nm_per_rad
