"""Where two bodies of revolution give K, a large solid mesh is not solved only to confirm it."""

from __future__ import annotations

from pathlib import Path

import pytest
from example_files import EXAMPLES

from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design
from flexspline.pipeline import part_stiffness, solid_torsion
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress

CUP = load_design(EXAMPLES / "xb1-40.toml").changed({"solver.tolerance_pct": 0.2})
"""Its enclosure is narrower; its first mesh has 4 206 elements."""
MOST = 1_000


@pytest.fixture
def large(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its first mesh, however coarse, has more than that."""
    for limit in ("FIRST_ELEMENTS", "CONFIRMING_ELEMENTS"):
        monkeypatch.setattr(solid_torsion, limit, MOST)


def answer(design: Design, folder: Path):
    said: list[str] = []
    context = AnalysisContext(design, Cache(folder), Progress(said.append))
    part = context.part("flexspline")
    return part, part_stiffness.part_stiffness(part), [line for line in said if "elements" in line]


def test_the_enclosure_answers_alone(large: None, tmp_path: Path) -> None:
    part, found, solved = answer(CUP, tmp_path)
    assert not solved
    assert found == part_stiffness.torsion_enclosure(part)
    assert not found.shortfall


def test_the_field_under_torque_is_solved_all_the_same(large: None, tmp_path: Path) -> None:
    part, found, _ = answer(CUP, tmp_path)
    field = part_stiffness.twisted_part(part)
    assert field.meshed.mesh.elements > MOST
    low, high = found.lower_Nm_per_rad, found.upper_Nm_per_rad
    assert field.stiffness.lower_Nm_per_rad < high
    assert field.stiffness.upper_Nm_per_rad > low


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("solver.tolerance_pct", 0.05),  # narrower than the enclosure
        ("solver.edge_length_mm", 1.2),
        ("solver.mesher", "swept"),
    ],
)
def test_a_solid_that_is_needed_or_asked_for_is_solved(
    large: None, tmp_path: Path, key: str, value: float | str
) -> None:
    assert answer(CUP.changed({key: value}), tmp_path)[2]


def test_a_mesh_is_made_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """To look at its size, and to solve it."""
    made: list[object] = []
    sweep = part_stiffness.PartMeshes.swept

    def counted(self, *given, **named):
        made.append(given)
        return sweep(self, *given, **named)

    monkeypatch.setattr(part_stiffness.PartMeshes, "swept", counted)
    assert answer(CUP, tmp_path)[2]
    assert len(made) == 1
