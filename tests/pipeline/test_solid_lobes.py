"""Which meshes the lobe cases of a part with holes are solved on by the solid model alone."""

from __future__ import annotations

from pathlib import Path

import pytest
from example_files import EXAMPLES

from flexspline.fea.errors import SolidError
from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design
from flexspline.pipeline import solid_lobes
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.part_stiffness import rim_mesh
from flexspline.pipeline.parts import AnalysisContext, PartModel
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.rim_size import copies_in_rim

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


def first_elements(part: PartModel, supported: bool) -> int:
    """Of the part's quarter."""
    mesh, _ = next(solid_lobes.lobe_meshes(part, supported))
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


def test_where_its_own_mesh_is_too_large_a_free_rim_begins_on_torsions(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    part = model(folder)
    usual = first_elements(part, supported=False)
    monkeypatch.setattr(solid_lobes, "MOST_LOBE_ELEMENTS", usual - 1)
    assert (
        first_elements(part, supported=False) == copies_in_rim(part) * rim_mesh(part).mesh.elements
    )
    with pytest.raises(SolidError, match=f"at most {usual - 1}"):
        list(solid_lobes.lobe_meshes(part, supported=False))
