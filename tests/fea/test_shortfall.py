"""A refinement that cannot go on gives what it has, with bounds that hold and the reason why it ended."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from example_cup import CUP
from lobe_stiffness import lobe_stiffness

from flexspline.fea.axisymmetric import lobes, peak_refinement, stress, torsion
from flexspline.fea.errors import MemoryShortError, MesherError, MesherTimeError
from flexspline.fea.shortfall import ToleranceError, missing_because, next_mesh_failed, settled
from flexspline.fea.solid import stiffness
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.field_solver import FULL_SCALES
from flexspline.fea.solid.mesh import MeshSpec
from flexspline.fea.solid.stiffness import MeshSequence, solid_stiffness
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.torsion_field import FullTorsion
from flexspline.fea.types import Elastic, Shortfall, Stiffness, TetMesh
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.load import load_design
from flexspline.geometry.symmetry import sector_of

STEEL = Elastic(206e3, 0.3)
OUTLINE = CUP.meridian()
WHY = "the mesher met its time limit"
UNREACHABLE = 1e-7


@pytest.fixture(scope="module")
def exact() -> Stiffness:
    """Bounds 0.02 % apart, that are theorems."""
    return torsion.torsional_stiffness(OUTLINE, STEEL, "mesh", 2e-4)


def failing_after(
    calls: int, function: Callable[..., Any], fault: Exception | None = None
) -> Callable[..., Any]:
    """The function itself so many times, then a fault, our own error by default."""
    left = [calls]

    def asked(*given: Any) -> Any:
        if not left[0]:
            raise fault or ComputationError(WHY)
        left[0] -= 1
        return function(*given)

    return asked


def held(k: Stiffness, true: Stiffness) -> bool:
    return (
        k.lower_Nm_per_rad <= true.lower_Nm_per_rad <= true.upper_Nm_per_rad <= k.upper_Nm_per_rad
    )


def test_bounds_of_a_mesh_that_is_the_largest(exact: Stiffness, monkeypatch) -> None:
    monkeypatch.setattr(torsion, "MOST_TRIANGLES", 100)
    found = torsion.torsional_stiffness(OUTLINE, STEEL, "mesh", UNREACHABLE)
    assert found.guaranteed
    assert "a mesh of more than 100 elements is not refined" in found.shortfall.words
    assert held(found, exact)


@pytest.mark.parametrize("meshes", [1, 2])
def test_bounds_before_a_mesh_that_fails(meshes: int, exact: Stiffness, monkeypatch) -> None:
    monkeypatch.setattr(torsion, "bracket", failing_after(meshes, torsion.bracket))
    found = torsion.torsional_stiffness(OUTLINE, STEEL, "mesh", UNREACHABLE)
    assert len(found.levels) == meshes
    assert WHY in found.shortfall.words
    assert held(found, exact)


def test_memory_that_ends_costs_the_finer_mesh_only(exact: Stiffness, monkeypatch) -> None:
    short = failing_after(1, torsion.bracket, MemoryError("1 GiB"))
    monkeypatch.setattr(torsion, "bracket", short)
    found = torsion.torsional_stiffness(OUTLINE, STEEL, "mesh", UNREACHABLE)
    assert held(found, exact)
    assert "not enough memory 1 GiB" in found.shortfall.words
    assert found.shortfall.of_the_machine  # another machine, or this one later, may do better


def test_a_first_mesh_that_fails_is_an_error(monkeypatch) -> None:
    monkeypatch.setattr(torsion, "bracket", failing_after(0, torsion.bracket))
    with pytest.raises(ComputationError, match=WHY):
        torsion.torsional_stiffness(OUTLINE, STEEL, "mesh", UNREACHABLE)


@pytest.mark.parametrize("supported", [True, False])
def test_lobes_before_a_mesh_that_fails(supported: bool, monkeypatch) -> None:
    true = lobe_stiffness(OUTLINE, STEEL, supported, 0.003)
    monkeypatch.setattr(lobes, "solve_lobes", failing_after(1, lobes.solve_lobes))
    found = lobe_stiffness(OUTLINE, STEEL, supported, 0.003)
    assert (len(found.levels), found.guaranteed) == (1, False)
    assert WHY in found.shortfall.words
    # one mesh: the largest factor of true over estimated error that is believed
    assert found.error_scale == lobes.ERROR_SCALES[1]
    assert found.lower_Nm_per_rad <= true.K_Nm_per_rad <= found.upper_Nm_per_rad


def test_a_peak_before_a_mesh_that_fails(monkeypatch) -> None:
    short = failing_after(2, peak_refinement.peak_stress)
    monkeypatch.setattr(peak_refinement, "peak_stress", short)
    found = stress.ellipse_stress(OUTLINE, STEEL, 0.2, CUP.wall_thickness_mm, 1e-3)
    assert len(found.levels) == 2
    assert found.peak.mises_MPa == found.levels[-1].mises_MPa
    assert WHY in found.peak.shortfall.words


def solved(meshes: int, most: int, monkeypatch) -> tuple[Stiffness, list[str]]:
    """The cup as a solid; its mesher makes so many meshes, of at most `most` that are allowed."""
    monkeypatch.setattr(stiffness, "MAX_LEVELS", most)
    design = load_design("examples/xb1-40.toml").model_copy(update={"flexspline": CUP})
    sector = sector_of(design.part("flexspline"), "torsion")
    said: list[str] = []

    def mesher(spec: MeshSpec) -> TetMesh:
        made = swept_mesh(design.part("flexspline"), sector.degrees, spec, None)
        assert made is not None
        return made

    def limited(spec: MeshSpec) -> TetMesh:
        if len(said) >= meshes:
            raise MesherError(WHY, "try a larger edge")
        return mesher(spec)

    found = solid_stiffness(
        MeshSequence(limited, first_spec(design.part("flexspline"))),
        FullTorsion(STEEL, "mesh"),
        1e-5,
        sector.label,
        said.append,
    )
    assert len(found.meshes) == len(found.stiffness.levels)
    assert len(found.turned.displacement) == len(found.meshes[-1].nodes)
    return found.stiffness, said


def test_the_solid_model_gives_the_mesh_before_the_one_that_failed(exact, monkeypatch) -> None:
    found, said = solved(1, 5, monkeypatch)
    assert WHY in found.shortfall.words
    assert WHY in said[-1]
    assert found.error_scale == FULL_SCALES.usual
    # one mesh: bounds as wide as twice the usual factor of true over estimated error
    assert held(found, exact)


def test_the_solid_model_gives_the_last_of_its_meshes(exact, monkeypatch) -> None:
    found, _ = solved(9, 1, monkeypatch)
    assert found.shortfall.words.endswith("after 1 mesh")
    assert held(found, exact)


def test_what_needs_the_tolerance_refuses_less(exact: Stiffness, monkeypatch) -> None:
    assert settled(exact) is exact
    monkeypatch.setattr(torsion, "MOST_TRIANGLES", 100)
    with pytest.raises(ToleranceError, match="a mesh of more than 100 elements is not refined"):
        settled(torsion.torsional_stiffness(OUTLINE, STEEL, "mesh", UNREACHABLE))


@pytest.mark.parametrize(
    ("fault", "expected"),
    [
        (MesherTimeError("it did not finish within 300 s", "try a larger edge"), True),
        (MemoryShortError(10**8, 1e12, 1e9), True),
        (MemoryError(), True),
        (MesherError("it ended with status 1", "try another edge"), False),
    ],
    ids=["time", "memory of a solver", "memory", "crash"],
)
def test_a_better_machine_may_mend_some_faults(fault: Exception, expected: bool) -> None:
    assert next_mesh_failed(fault).of_the_machine is expected


@pytest.mark.parametrize("mended", [True, False])
def test_what_misses_a_figure_out_of_tolerance_knows_why_that_was(mended: bool) -> None:
    fault = ToleranceError("K is known to ± 1 % only", Shortfall("no time", mended))
    assert missing_because(fault) == Shortfall("K is known to ± 1 % only: no time", mended)
