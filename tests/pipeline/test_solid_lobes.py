"""Which meshes the lobe cases of a part with holes are solved on, and when none is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from example_files import EXAMPLES
from wrong_models import without_torsion

from flexspline.fea.errors import NoBetterMeshError
from flexspline.fea.solid.lobes import promised
from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design
from flexspline.pipeline import load_cases, solid_lobes
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.enclosed_part import TOO_FAR, enclosure_of
from flexspline.pipeline.load_cases import CASES, rim_stiffness
from flexspline.pipeline.part_stiffness import rim_mesh
from flexspline.pipeline.parts import AnalysisContext, PartModel
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.solid_torsion import copies_in_rim

WIDE = load_design(EXAMPLES / "xb1-40.toml").changed(
    {
        "flexspline.bolt_hole_diameter_mm": 4.4,
        "flexspline.diaphragm_thickness_mm": 1.5,
        "solver.tolerance_pct": 1.0,
    }
)
"""Large holes that leave 0.3 mm of the boss beside them: the two bodies are 5 % apart."""


@pytest.fixture(scope="module")
def folder(suite_cache: Path) -> Path:
    """One cache: the torsion mesh is the same for all, what differs here is not kept in it."""
    return suite_cache


def model(folder: Path, design: Design = WIDE) -> PartModel:
    context = AnalysisContext(design, Cache(folder), Progress())
    return context.part("flexspline")


def first_elements(part: PartModel, supported: bool, known: float = 1.0) -> int:
    """Of the part's quarter."""
    mesh, _ = next(solid_lobes.lobe_meshes(part, supported, known))
    return copies_in_rim(part) * mesh.elements


def test_a_held_rim_begins_on_the_mesh_of_torsion_where_that_promises_enough(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    part = model(folder)
    of_torsion = copies_in_rim(part) * rim_mesh(part).mesh.elements
    monkeypatch.setattr(solid_lobes, "USUAL_OVER_TORSION", 0.0)
    assert first_elements(part, supported=True) == of_torsion
    monkeypatch.setattr(solid_lobes, "USUAL_OVER_TORSION", 1e3)
    assert first_elements(part, supported=True) == first_elements(part, supported=False)
    assert first_elements(part, supported=True) != of_torsion


def test_a_first_mesh_of_its_own_may_be_coarser(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    part = model(folder)
    usual = first_elements(part, supported=False)
    monkeypatch.setattr(solid_lobes, "MOST_LOBE_ELEMENTS", usual - 1)
    assert first_elements(part, supported=False) < usual


def test_a_coarser_mesh_is_made_only_where_it_promises_much_less_than_is_known(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    part = model(folder)
    usual = first_elements(part, supported=False)
    monkeypatch.setattr(solid_lobes, "MOST_LOBE_ELEMENTS", usual - 1)
    # 1 % asked; on steps 1/0.7 times as long the fourth power is 4.2 times as large
    expected = promised(0.01, solid_lobes.COARSER_MESH)
    assert 0.02 < expected < 0.03
    share = solid_lobes.WORTH_SHARE
    assert first_elements(part, False, known=1.01 * expected / share) < usual
    with pytest.raises(NoBetterMeshError):
        first_elements(part, False, known=0.99 * min(expected, solid_lobes.USUAL_OF_FREE) / share)


@pytest.mark.parametrize("supported", [True, False])
def test_no_mesh_is_solved_that_promises_no_better_bounds(
    supported: bool, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    part = model(folder)
    monkeypatch.setattr(solid_lobes, "MOST_LOBE_ELEMENTS", 1)
    monkeypatch.setattr(solid_lobes, "USUAL_OVER_TORSION", 1e3)
    with pytest.raises(NoBetterMeshError) as caught:
        solid_lobes.solid_lobes(part, supported, known=1e-4)
    assert caught.value.expected > caught.value.known == 1e-4
    assert first_elements(part, supported, known=10.0) > 1  # of torsion


def test_a_small_mesh_is_solved_whatever_is_expected(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    part = model(folder)
    monkeypatch.setattr(solid_lobes, "MOST_LOBE_ELEMENTS", 1)
    monkeypatch.setattr(solid_lobes, "USUAL_OVER_TORSION", 1e3)
    monkeypatch.setattr(solid_lobes, "USUAL_OF_FREE", 1e3)
    quarter = rim_mesh(part).mesh.elements * copies_in_rim(part)
    monkeypatch.setattr(solid_lobes, "SMALL_ELEMENTS", quarter)
    for supported in (True, False):
        assert first_elements(part, supported, known=1e-4) > 1
    monkeypatch.setattr(solid_lobes, "SMALL_ELEMENTS", quarter - 1)
    with pytest.raises(NoBetterMeshError):
        first_elements(part, True, known=1e-4)


def test_the_enclosure_then_answers_and_says_why(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    part = model(folder)
    monkeypatch.setattr(solid_lobes, "MOST_LOBE_ELEMENTS", 1)
    monkeypatch.setattr(solid_lobes, "USUAL_OF_FREE", 1.0)
    found = rim_stiffness(part, "lobes_unsupported")
    known = enclosure_of(part, CASES["lobes_unsupported"].revolved)
    assert known.half_width > 0.01  # as asked for
    assert found.bounds_Nm_per_rad == known.bounds_Nm_per_rad
    assert found.shortfall.words.startswith(TOO_FAR)
    assert "expected" in found.shortfall.words
    assert "failed" not in found.shortfall.words


def test_the_case_is_told_what_is_known(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    without_torsion(monkeypatch)
    told: list[float] = []

    def stands_in(part: PartModel, supported: bool, known: float) -> None:
        told.append(known)
        raise NoBetterMeshError(1.0, known)

    case = replace(CASES["lobes"], solid=lambda part, known: stands_in(part, True, known))
    monkeypatch.setattr(load_cases, "CASES", {**CASES, "lobes": case})
    found = rim_stiffness(model(folder), "lobes")
    assert told == [found.half_width]
