"""Large solid meshes: what is said of them, and what is advised instead."""

from __future__ import annotations

from pathlib import Path

import pytest
from example_files import EXAMPLES

from flexspline.fea.errors import SolidError, TooManyElementsError
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.swept_sizing import MOST_ELEMENTS
from flexspline.geometry.load import load_design
from flexspline.pipeline import mesh_words, part_meshes, part_stiffness, solid_torsion
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress

DESIGN = load_design(EXAMPLES / "xb1-40.toml").changed({"solver.tolerance_pct": 5.0})
STATED = DESIGN.changed({"solver.edge_length_mm": 4.0})


def test_what_tells_k_closer_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The model of the whole field is coarse; without a choice holes alone are solved."""
    monkeypatch.setattr(solid_torsion, "HALVED_ELEMENTS", 100)
    half, words = {}, {}
    for model in ("solid", "auto"):
        design = DESIGN.changed({"solver.tolerance_pct": 0.01, "solver.model": model})
        shaft = AnalysisContext(design, Cache(tmp_path), Progress()).part("shaft")
        found = part_stiffness.part_stiffness(shaft)
        half[model], words[model] = found.half_width, found.shortfall.words
    assert half["auto"] < half["solid"] / 3
    assert 'solver.model = "auto" gives tighter bounds of K' in words["solid"]
    assert words["auto"].endswith("; raise solver.tolerance_pct")
    stated = STATED.changed({"solver.tolerance_pct": 0.01})
    found = part_stiffness.part_stiffness(
        AnalysisContext(stated, Cache(tmp_path), Progress()).part("shaft")
    )
    assert "without solver.edge_length_mm" in found.shortfall.words


def test_a_stated_edge_that_asks_for_too_much_is_refused_with_one_that_fits(tmp_path: Path) -> None:
    """Not with the advice to state it."""
    short = AnalysisContext(
        DESIGN.changed({"solver.edge_length_mm": 0.15}), Cache(tmp_path), Progress()
    ).part("shaft")
    with pytest.raises(
        SolidError, match=r"solver\.edge_length_mm = 0\.15 asks for .* fits$"
    ) as refused:
        part_stiffness.part_stiffness(short)
    assert "unless" not in str(refused.value)
    fits = first_spec(short.part, float(str(refused.value).split()[-2]))
    with pytest.raises(TooManyElementsError) as counted:
        part_meshes.swept_mesh(short.part, short.sector.degrees, fits, None, 0)
    assert 50_000 < counted.value.elements < MOST_ELEMENTS


def test_a_long_solve_is_announced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mesh_words, "LONG_ELEMENTS", 1000)
    said: list[str] = []
    shaft = AnalysisContext(STATED, Cache(tmp_path), Progress(said.append)).part("shaft")
    elements = part_stiffness.part_stiffness(shaft).levels[0].elements
    announced = f"{elements} elements by solver.edge_length_mm = 4: solved in about 2 s"
    (before,) = (i for i, line in enumerate(said) if announced in line)
    assert any(f"{elements} elements, K ±" in line for line in said[before + 1 :])
    assert not any("solved in about" in line for line in said[:before])
