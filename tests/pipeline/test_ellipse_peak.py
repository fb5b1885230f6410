"""The ellipse's peak of a flexspline with bolt holes: by two bodies of revolution, or by the solid model."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from example_files import EXAMPLES
from finished_run import FinishedRun

from flexspline.fea.axisymmetric.stress import ellipse_stress
from flexspline.fea.types import Elastic, SolidField, TetMesh
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.keys import with_values
from flexspline.geometry.load import load_design
from flexspline.pipeline import ellipse_peak as under_test
from flexspline.pipeline import part_meshes, peak_with_holes
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.parts import AnalysisContext, PartModel
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.wave_generator import solid_ellipse

CUP = load_design(EXAMPLES / "xb1-40.toml")
SOLID_MPa, SUPERPOSED_MPa = -1.0, -2.0
"""What the solid model and the superposition stand in with: no true peaks."""


def model(design: Design, folder: Path) -> PartModel:
    return AnalysisContext(design, Cache(folder), Progress()).part("flexspline")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of the solves of all these tests, each made once; which of them answers is kept nowhere."""
    return tmp_path_factory.mktemp("solves")


@pytest.fixture
def part(folder: Path, monkeypatch: pytest.MonkeyPatch) -> PartModel:
    """The example cup; its solid model says SOLID_MPa, the superposition SUPERPOSED_MPa."""
    cup = model(CUP, folder)
    whole = under_test.ellipse_peak(replace(cup, part=cup.part.without_holes()))
    asked: dict[str, Any] = {"mesh": None, "load_case": "", "displacement": None, "mises": None}
    stand_ins = (("solid_ellipse", SOLID_MPa), ("superposed_ellipse", SUPERPOSED_MPa))
    for name, value in stand_ins:
        field = SolidField(**asked, peak=replace(whole, mises_MPa=value))
        monkeypatch.setattr(under_test, name, partial(_stand_in, field))
    return cup


def _stand_in(field: SolidField, asked: PartModel) -> SolidField:
    return field


def test_a_peak_is_as_close_as_K_is_asked_for(folder: Path) -> None:
    cup = model(CUP, folder).part
    w0, apart, own = CUP.w0_mm, cup.exclusion_mm, Elastic.of(cup.material)
    finest = ellipse_stress(cup.without_holes().meridian, own, w0, apart, 0.0002).peak.mises_MPa
    off_pct = []
    for asked in (0.5, 0.1):
        design = with_values(CUP, {"solver.tolerance_pct": asked, "flexspline.bolt_count": 0})
        found = under_test.ellipse_peak(model(design, folder))
        off_pct.append(abs(100 * (found.mises_MPa / finest - 1)))
        assert off_pct[-1] < asked
    assert off_pct[1] < off_pct[0] / 2  # edges of one more refinement are half as long


def test_bodies_that_agree_answer_with_the_one_that_has_no_holes(part: PartModel) -> None:
    whole = under_test.ellipse_peak(replace(part, part=part.part.without_holes()))
    found = under_test.ellipse_peak(part)
    assert found == replace(whole, stands_for=peak_with_holes.WITHOUT_HOLES)
    assert not whole.stands_for


def test_bodies_that_differ_leave_it_to_the_superposition(part, monkeypatch) -> None:
    monkeypatch.setattr(
        peak_with_holes, "AGREEMENT", 0.0
    )  # two meshes never agree to the last digit
    assert under_test.ellipse_peak(part).mises_MPa == SUPERPOSED_MPa


@pytest.mark.parametrize(("share", "answered"), [(0.5, True), (0.8, False)])
def test_stress_at_the_holes_is_looked_up_where_its_bound_is_too_high(
    part: PartModel, monkeypatch: pytest.MonkeyPatch, share: float, answered: bool
) -> None:
    """Of the peak, at one node of a solid model in the annulus of the holes; more of it at the rim."""
    monkeypatch.setattr(peak_with_holes, "KIRSCH", 1e3)
    whole = under_test.ellipse_peak(replace(part, part=part.part.without_holes()))
    bolts = part.part.bolts
    assert bolts is not None
    at = np.array([[bolts.radius, 0.0, 0.0], [0.0, 20.0, 30.0]])
    mesh: Any = SimpleNamespace(nodes=at)
    mises = np.array([share, 1.0]) * whole.mises_MPa
    field = SolidField(mesh, "", np.zeros((2, 3)), mises, whole)
    monkeypatch.setattr(under_test, "coarse_ellipse", lambda asked: field)
    found = under_test.ellipse_peak(part).mises_MPa
    assert found == (whole.mises_MPa if answered else SUPERPOSED_MPa)


def test_where_no_mesh_can_be_made_the_peak_without_holes_is_given_and_said(
    part: PartModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*given: object) -> SolidField:
        raise ComputationError("no mesh")

    monkeypatch.setattr(peak_with_holes, "KIRSCH", 1e3)
    for name in ("coarse_ellipse", "solid_ellipse", "superposed_ellipse"):
        monkeypatch.setattr(under_test, name, fails)
    found = under_test.ellipse_peak(part)
    whole = under_test.ellipse_peak(replace(part, part=part.part.without_holes()))
    assert found.mises_MPa == whole.mises_MPa
    assert found.shortfall.words == "the stress at the bolt holes is not known: no mesh"
    monkeypatch.setattr(peak_with_holes, "AGREEMENT", 0.0)
    with pytest.raises(ComputationError, match="no mesh"):
        under_test.ellipse_peak(part)


def test_the_solid_model_by_name_answers_itself(part: PartModel, folder: Path) -> None:
    by_name = model(CUP.changed({"solver.model": "solid"}), folder)
    peak = under_test.ellipse_peak(by_name)
    assert peak.mises_MPa == SOLID_MPa
    # twice as large by the superposition: said
    assert "plus what these change, has -2 MPa" in peak.shortfall.words
    assert not under_test.ellipse_peak(part).shortfall


def test_where_nothing_can_be_superposed_the_solid_models_peak_is_doubted(
    part: PartModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(asked: PartModel) -> SolidField:
        raise ComputationError("no walls")

    monkeypatch.setattr(peak_with_holes, "AGREEMENT", 0.0)
    monkeypatch.setattr(under_test, "superposed_ellipse", fails)
    peak = under_test.ellipse_peak(part)
    assert peak.mises_MPa == SOLID_MPa
    assert "no walls" in peak.shortfall.words


def test_a_row_of_holes_raises_the_stress_more_than_one_hole() -> None:
    """Six holes of 2.5 mm on a circle of 13 mm, 6.5 mm apart: 4·6.5/(6.5 − 2.5) = 6.5 times."""
    six = CUP.part("flexspline").bolts
    assert six is not None
    assert peak_with_holes.raised(1.0, six) == pytest.approx(6.5)
    assert peak_with_holes.raised(1.0, replace(six, count=1)) == pytest.approx(4.0)


@pytest.mark.long  # without holes by default: tests/verification/test_peak_on_the_ellipse.py
def test_the_solid_model_with_its_holes_has_the_same_peak(finished_cup: FinishedRun) -> None:
    """1.5 %: what its mesh may be off without holes."""
    part = model(CUP, finished_cup.cache)
    solid = solid_ellipse(part).peak
    assert not solid.shortfall
    assert solid.mises_MPa == pytest.approx(under_test.ellipse_peak(part).mises_MPa, rel=0.015)


def test_a_peak_on_a_mesh_that_is_not_refined_there_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A mesh of fTetWild's is that of K, and has a peak that a finer one may move by a tenth.

    A swept one stands in for it: how it was made is what the program goes by.
    """
    unswept = {"solver.mesher": "tetwild", "solver.tolerance_pct": 5.0}
    cup = model(CUP.changed(unswept), tmp_path)

    def stands_in(*asked: object) -> TetMesh:
        mesh = part_meshes.swept_mesh(cup.part, cup.sector.degrees, cup.first_spec)
        assert mesh is not None
        return mesh

    surface = SimpleNamespace(sharp_edges=np.empty((0, 3)))
    monkeypatch.setattr(part_meshes, "surface_to_mesh", lambda *_: surface)
    monkeypatch.setattr(part_meshes, "mesh_surface", stands_in)
    peak = solid_ellipse(cup).peak
    assert "not refined at the peak" in peak.shortfall.words


def test_the_stress_is_of_the_stroke_that_is_stated(tmp_path: Path) -> None:
    """Linear: a plug that is a quarter larger bends the rim by a quarter more."""
    plain = CUP.changed({"flexspline.bolt_count": 0, "shaft.bolt_count": 0})
    usual, larger = (
        under_test.ellipse_peak(model(design, tmp_path)).mises_MPa
        for design in (plain, plain.changed({"wave_generator.deflection_mm": 0.25}))
    )
    assert CUP.gear.centre_distance_mm == 0.2
    assert larger == pytest.approx(1.25 * usual, rel=1e-3)  # two refined meshes of the same part
