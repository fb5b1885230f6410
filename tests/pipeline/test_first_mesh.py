"""A solid mesh of too many elements is made coarser, unless the user says how long its edges are; and what
becomes of a sweep that fails a check."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.fea.errors import (
    MesherTimeError,
    MeshQualityError,
    SolidError,
    TooManyElementsError,
)
from flexspline.fea.solid import stiffness
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.mesh import MeshSpec
from flexspline.fea.solid.stiffness import MeshSequence
from flexspline.fea.solid.swept_sizing import Finer
from flexspline.fea.types import TetMesh
from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design
from flexspline.geometry.part import Part
from flexspline.geometry.symmetry import sector_of
from flexspline.pipeline import (
    part_meshes,
    part_stiffness,
    parts,
    rim_size,
    solid_torsion,
)
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.part_meshes import MeshedPart, OtherKindError, PartMeshes
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress

DESIGN = load_design(EXAMPLES / "xb1-40.toml").changed({"solver.tolerance_pct": 5.0})
STATED = DESIGN.changed({"solver.edge_length_mm": 4.0})


class MeshedError(Exception):
    """The first mesh is made."""


def first_elements(design: Design, folder: Path) -> int:
    """Of the first mesh of its shaft, which is not solved."""

    def only_meshed(meshes: MeshSequence, *_: object) -> None:
        raise MeshedError(meshes.make(meshes.first).elements)

    context = AnalysisContext(design, Cache(folder), Progress())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(solid_torsion, "solid_stiffness", only_meshed)
        with pytest.raises(MeshedError) as made:
            part_stiffness.part_stiffness(context.part("shaft"))
    return made.value.args[0]


def test_the_first_mesh_is_made_coarser(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """For a design that asks for 5 %, and has holes; one that asks for 0.1 % has another limit."""
    monkeypatch.setattr(solid_torsion, "COARSE_FIRST_ELEMENTS", inf)
    usual = first_elements(DESIGN, tmp_path / "usual")
    monkeypatch.setattr(solid_torsion, "COARSE_FIRST_ELEMENTS", usual - 1)
    assert first_elements(DESIGN, tmp_path / "coarser") < usual
    fine = DESIGN.changed({"solver.tolerance_pct": 0.1})
    monkeypatch.setattr(solid_torsion, "FIRST_ELEMENTS", inf)
    assert first_elements(fine, tmp_path / "fine") == usual
    monkeypatch.setattr(solid_torsion, "FIRST_ELEMENTS", usual - 1)
    assert first_elements(fine, tmp_path / "fine, coarser") < usual


@pytest.mark.parametrize("fault", [SolidError("it fails a check"), OtherKindError("tetwild")])
def test_a_coarse_first_mesh_that_cannot_be_made_is_no_end(
    fault: Exception, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whether it has too few elements is asked beforehand; the mesh itself is made, or fails, later."""
    usual = first_elements(DESIGN, tmp_path / "usual")
    make, asked = PartMeshes.meshed, []

    def fails_once(meshes: PartMeshes, spec: MeshSpec) -> MeshedPart:
        asked.append(spec)
        if len(asked) == 1:
            raise fault
        return make(meshes, spec)

    monkeypatch.setattr(PartMeshes, "meshed", fails_once)
    assert first_elements(DESIGN, tmp_path / "fails once") == usual
    assert len(asked) == 2


@pytest.mark.parametrize(("about_axis", "tries"), [(True, 2), (False, 7)])
def test_a_mesh_given_up_midway_says_little_about_the_next(
    about_axis: bool, tries: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In layers its elements may fall by little at first, and by much later."""
    asked: list[float] = []

    def given_up(self: PartMeshes, spec: MeshSpec, most_elements: float = inf) -> None:
        asked.append(spec.grading.near)
        if most_elements < inf:
            raise TooManyElementsError(100_000 - len(asked), most_elements)

    monkeypatch.setattr(part_meshes, "goes_about_axis", lambda part: about_axis)
    monkeypatch.setattr(PartMeshes, "swept", given_up)
    part = AnalysisContext(DESIGN, Cache(tmp_path), Progress()).part("shaft")
    PartMeshes(part).coarsened(12_000)
    assert len(set(asked)) == tries


def test_a_kept_mesh_in_layers_is_found_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By a part of another modulus, say, whose mesh is the same: it is not made with shorter edges."""
    context = AnalysisContext(DESIGN, Cache(tmp_path), Progress())
    first = PartMeshes(context.part("shaft"))
    made = first.layered(first.model.first_spec)

    def swept(self: PartMeshes, spec: MeshSpec, most_elements: float = inf) -> MeshedPart | None:
        if spec == first.model.first_spec:
            raise TooManyElementsError(100_000, most_elements)
        return made

    monkeypatch.setattr(part_meshes, "goes_about_axis", lambda part: False)
    monkeypatch.setattr(PartMeshes, "swept", swept)
    found = [PartMeshes(context.part("shaft")).coarsened(12_000) for _ in range(2)]
    assert found[1] == found[0]
    assert found[0] == first.model.first_spec.scaled(part_meshes.COARSER_EDGES)


def test_edges_stay_where_longer_ones_leave_as_many_elements(tmp_path: Path) -> None:
    """Holes 2.2 mm apart beside a step of 17 mm ask for 15 000 elements, however long the others are."""
    stepped = DESIGN.changed({
        "solver.tolerance_pct": 0.5,
        "shaft.segment[1].outer_diameter_mm": 17.0,
        "shaft.grip_length_mm": 10.0,
    })  # fmt: skip
    shaft = AnalysisContext(stepped, Cache(tmp_path), Progress()).part("shaft")
    found = part_stiffness.part_stiffness(shaft)
    meshes = [level.elements for level in found.levels]
    assert meshes[0] > solid_torsion.FIRST_ELEMENTS
    assert sorted(set(meshes)) == meshes  # each mesh is finer than the one before
    assert found.half_width <= 0.005


@pytest.mark.parametrize("kind", ["layered", pytest.param("tetwild", marks=pytest.mark.long)])
def test_a_sweep_that_fails_when_refined_is_left_altogether(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By its errors and by a specification. Another kind then makes every mesh: between two kinds K moves by
    more than its bounds."""
    sweep = PartMeshes.swept
    first: list[MeshSpec] = []

    def once(self: PartMeshes, spec: MeshSpec, *more: float) -> MeshedPart | None:
        first.append(spec)
        return sweep(self, spec, *more) if spec == first[0] else None

    def fails(*given: object) -> TetMesh:
        raise MeshQualityError("it fails a check")

    monkeypatch.setattr(PartMeshes, "swept", lambda self, spec, **more: once(self, spec))
    monkeypatch.setattr(solid_torsion, "finer_by_error", fails)
    if kind == "tetwild":
        monkeypatch.setattr(PartMeshes, "layered", lambda self, spec: None)
    monkeypatch.setattr(stiffness, "MAX_LEVELS", 2)
    design = DESIGN.changed({"solver.tolerance_pct": 0.4, "solver.model": "solid"})
    model = AnalysisContext(design, Cache(tmp_path), Progress()).part("shaft")
    by_mesher: list[MeshSpec] = []

    def stands_in(surface: object, spec: MeshSpec) -> TetMesh:
        by_mesher.append(spec)
        mesh = part_meshes.swept_mesh(model.part, model.sector.degrees, spec)
        assert mesh is not None
        return mesh

    monkeypatch.setattr(part_meshes, "mesh_surface", stands_in)
    found = part_stiffness.twisted_part(model)
    assert len(set(first)) > 1  # a finer sweep was asked for
    assert found.meshed.kind == kind
    made = [spec.grading for spec in by_mesher]
    assert (first[0].grading in made) is (kind == "tetwild")  # the first mesh too


def test_a_stated_edge_length_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stated = first_elements(STATED, tmp_path / "stated")
    monkeypatch.setattr(solid_torsion, "FIRST_ELEMENTS", 0)
    assert first_elements(STATED, tmp_path / "again") == stated


def test_the_rims_mesh_keeps_within_its_elements(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cup = AnalysisContext(DESIGN, Cache(tmp_path), Progress()).part("flexspline")
    usual = part_stiffness.rim_mesh(cup).mesh.elements
    copies = 3  # wedges of 30° in the ellipse's quarter
    assert rim_size.copies_in_rim(cup) == copies
    monkeypatch.setattr(rim_size, "HOLES_ALONE_ELEMENTS", copies * usual - 1)
    assert part_stiffness.rim_mesh(cup).mesh.elements < usual


def test_any_mesh_fits_of_a_shaft_whose_sector_is_larger_than_the_ellipses(tmp_path: Path) -> None:
    keyed = load_design(EXAMPLES / "keyed-shaft.toml")
    shaft = AnalysisContext(keyed, Cache(tmp_path), Progress()).part("shaft")
    assert rim_size.copies_in_rim(shaft) == 0
    assert rim_size.fits_rim(shaft, 10**6)


def test_a_sweep_that_fails_a_check_is_tried_once_more(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    said: list[str] = []
    context = AnalysisContext(DESIGN, Cache(tmp_path), Progress(said.append))
    meshes = PartMeshes(context.part("shaft"))
    spec = meshes.model.first_spec
    finer = meshes.swept(spec.scaled(part_meshes.SECOND_TRY_EDGES))
    assert finer is not None
    sweep = part_meshes.swept_mesh

    def fails_at_first(
        part: Part, degrees: float, asked: MeshSpec, more: Finer | None, most_elements: float
    ) -> TetMesh | None:
        return None if asked == spec else sweep(part, degrees, asked, more, most_elements)

    monkeypatch.setattr(part_meshes, "swept_mesh", fails_at_first)
    assert meshes.meshed(spec).mesh.elements == finer.mesh.elements
    assert not any("fTetWild" in line for line in said)


def test_edges_stated_as_they_are_chosen_are_another_question(tmp_path: Path) -> None:
    """To save time a mesh may have longer ones, where nobody has stated them."""
    usual = AnalysisContext(DESIGN, Cache(tmp_path), Progress()).part("flexspline")
    edge = usual.first_spec.grading.far
    stated = replace(usual.context, design=DESIGN.changed({"solver.edge_length_mm": edge})).part(
        "flexspline"
    )
    assert stated.first_spec == usual.first_spec
    assert stated.torsion_key != usual.torsion_key
    PartMeshes(usual).meshed(usual.first_spec)
    assert len(list(tmp_path.glob("**/mesh/*"))) == 1
    PartMeshes(stated).meshed(stated.first_spec)
    assert len(list(tmp_path.glob("**/mesh/*"))) == 2


@pytest.mark.parametrize("stated", [False, True])
def test_a_first_mesh_in_layers_is_made_coarser_too(
    stated: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    design = DESIGN.changed({"solver.edge_length_mm": 2.0}) if stated else DESIGN
    context = AnalysisContext(design, Cache(tmp_path), Progress())
    meshes = PartMeshes(context.part("shaft"))
    usual = meshes.layered(meshes.model.first_spec)
    assert usual is not None
    monkeypatch.setattr(part_meshes, "FIRST_ELEMENTS", usual.mesh.elements - 1)
    coarser = meshes.layered(meshes.model.first_spec)
    assert coarser is not None
    if stated:  # the user says how long edges are
        assert coarser.mesh.elements == usual.mesh.elements
    else:
        assert coarser.mesh.elements < usual.mesh.elements


@pytest.mark.parametrize("most", [100, 10**6])
def test_a_first_mesh_in_layers_that_is_very_large_is_the_only_one(
    most: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A second one would take longer to make than is left to solve it."""
    monkeypatch.setattr(solid_torsion, "HALVED_ELEMENTS", most)
    monkeypatch.setattr(stiffness, "MAX_LEVELS", 2)
    design = DESIGN.changed({"solver.tolerance_pct": 0.1, "solver.model": "solid"})
    part = AnalysisContext(design, Cache(tmp_path), Progress()).part("shaft")
    found = solid_torsion.twisted(part, part.tolerance, kinds=("layered",)).stiffness
    assert len(found.levels) == (1 if most == 100 else 2)
    assert ("a mesh of more than 100 elements is not refined" in str(found.shortfall)) is (
        most == 100
    )
    assert found.half_width > part.tolerance


def test_a_tolerance_out_of_reach_ends_no_earlier(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the next mesh would not have met it, none was made of a mesh in layers: a looser one, which that
    mesh met, had narrower bounds."""
    monkeypatch.setattr(solid_torsion, "HALVED_ELEMENTS", 20_000)
    design = DESIGN.changed({"solver.model": "solid"})
    model = AnalysisContext(design, Cache(tmp_path), Progress()).part("shaft")
    found = solid_torsion.twisted(model, 1e-8, kinds=("layered",)).stiffness
    *_, before, last = (level.elements for level in found.levels)
    assert before <= 20_000 < last


def test_fTetWild_has_little_time_where_an_enclosure_answers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The mesh after it, with longer edges, has all the time of a first one, and is for the fields only."""
    context = AnalysisContext(
        DESIGN.changed({"solver.mesher": "tetwild"}), Cache(tmp_path), Progress()
    )
    cup = context.part("flexspline")
    asked: list[MeshSpec] = []

    def slow(surface: object, spec: MeshSpec) -> TetMesh:
        asked.append(spec)
        if spec.time_limit_s == solid_torsion.ENCLOSED_SECONDS:
            raise MesherTimeError("it is slow", "wait")
        mesh = part_meshes.swept_mesh(cup.part, cup.sector.degrees, cup.first_spec)
        assert mesh is not None
        return mesh

    monkeypatch.setattr(part_meshes, "mesh_surface", slow)
    monkeypatch.setattr(
        part_meshes, "surface_to_mesh", lambda *_: SimpleNamespace(sharp_edges=np.empty((0, 3)))
    )
    found = part_stiffness.part_stiffness(cup)
    assert found.guaranteed
    assert not found.shortfall
    assert found.model == "solid"  # as `solver.mesher` asks for it
    solid = part_stiffness.twisted_part(cup).stiffness
    first, second = asked
    assert second.grading == first.grading.scaled(solid_torsion.COARSER_FIRST)
    assert second.time_limit_s > first.time_limit_s
    assert part_stiffness.rim_mesh(cup).mesh.elements == solid.levels[0].elements
    assert len(asked) == len([first, second])
    # another run may do better: said of its stress, and not kept
    assert solid.shortfall.of_the_machine
    assert "longer edges" in solid.shortfall.words
    again = AnalysisContext(cup.context.design, Cache(tmp_path), Progress()).part("flexspline")
    part_stiffness.twisted_part(again)
    assert asked[2:] == [first]  # the mesh with longer edges is kept


@pytest.mark.parametrize(
    ("fault", "times"),
    [
        (None, []),
        (MeshQualityError("a patch is described badly"), [1.0]),
        (MesherTimeError("it is slow", "wait"), [solid_torsion.COARSER_FIRST**2]),
    ],
    ids=["none", "quality", "time"],
)
def test_fTetWild_begins_with_longer_edges_where_cuts_are_solved_alone(
    fault: SolidError | None, times: list[float], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With shorter ones after a mesh that fails a check, with still longer ones after one that took long."""
    context = AnalysisContext(
        DESIGN.changed({"solver.mesher": "tetwild"}), Cache(tmp_path), Progress()
    )
    shaft = context.part("shaft")
    swept = part_meshes.swept_mesh(shaft.part, shaft.sector.degrees, shaft.first_spec)
    asked: list[MeshSpec] = []

    def fails_once(surface: object, spec: MeshSpec) -> TetMesh:
        asked.append(spec)
        if fault is not None and len(asked) == 1:
            raise fault
        assert swept is not None
        return swept

    monkeypatch.setattr(part_meshes, "mesh_surface", fails_once)
    monkeypatch.setattr(
        part_meshes, "surface_to_mesh", lambda *_: SimpleNamespace(sharp_edges=np.empty((0, 3)))
    )
    found = solid_torsion.twisted(shaft, shaft.tolerance).stiffness
    assert found.half_width < shaft.tolerance
    usual = shaft.first_spec.grading
    each = [solid_torsion.COARSER_FIRST, *times]
    assert [spec.grading for spec in asked] == [usual.scaled(by) for by in each]
    assert found.shortfall.of_the_machine == isinstance(fault, MesherTimeError)


def test_nobody_waits_for_fTetWild_where_an_enclosure_answers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """K_b of a cup that cannot be swept: two bodies of revolution meet the tolerance, and answer."""

    def not_asked_for(*_: object) -> None:
        raise AssertionError("a mesh, or its CAD")

    context = AnalysisContext(DESIGN, Cache(tmp_path), Progress())
    cup = context.part("flexspline")
    monkeypatch.setattr(parts, "can_be_swept", lambda part: False)
    monkeypatch.setattr(part_meshes, "mesh_surface", not_asked_for)
    monkeypatch.setattr(part_meshes, "surface_to_mesh", not_asked_for)
    found = part_stiffness.part_stiffness(cup)
    assert found.guaranteed
    assert found.model == "axisymmetric"
    assert found.half_width <= DESIGN.solver.tolerance_pct / 100


def test_a_mesh_that_would_be_too_large_is_counted_not_made() -> None:
    part = DESIGN.part("shaft")
    degrees = sector_of(part, "torsion").degrees
    mesh = part_meshes.swept_mesh(part, degrees, first_spec(part))
    assert mesh is not None
    most = mesh.elements
    again = part_meshes.swept_mesh(part, degrees, first_spec(part), None, most)
    assert again is not None
    with pytest.raises(TooManyElementsError) as refused:
        part_meshes.swept_mesh(part, degrees, first_spec(part), None, most - 1)
    assert refused.value.elements == most
