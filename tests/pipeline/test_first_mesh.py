"""A first solid mesh of too many elements is made coarser, unless the user says how long its edges are."""

from __future__ import annotations

from pathlib import Path

import pytest

from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design
from flexspline.pipeline import part_stiffness
from flexspline.pipeline.analysis import CACHED_TYPES
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress

DESIGN = load_design(Path(__file__).parents[2] / "examples" / "xb1-40.toml").changed(
    {"solver.tolerance_pct": 5.0}
)
STATED = DESIGN.changed({"solver.edge_length_mm": 4.0})


def first_elements(design: Design, folder: Path) -> int:
    context = AnalysisContext(design, Cache(folder, CACHED_TYPES), Progress())
    return part_stiffness.part_stiffness(context.part("shaft")).levels[0].elements


def test_the_first_mesh_is_made_coarser(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    usual = first_elements(DESIGN, tmp_path / "usual")
    monkeypatch.setattr(part_stiffness, "FIRST_ELEMENTS", usual - 1)
    assert first_elements(DESIGN, tmp_path / "coarser") < usual


def test_a_stated_edge_length_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stated = first_elements(STATED, tmp_path / "stated")
    monkeypatch.setattr(part_stiffness, "FIRST_ELEMENTS", 0)
    assert first_elements(STATED, tmp_path / "again") == stated
