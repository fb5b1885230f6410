"""A finer mesh that would end too late is not begun; the coarse one's K stays, and why is said."""

from __future__ import annotations

from functools import cache

from example_files import EXAMPLES

from flexspline.fea.deadline import Deadline
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.mesh import MeshSpec
from flexspline.fea.solid.stiffness import MeshSequence, solid_stiffness
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.torsion_field import FullTorsion
from flexspline.fea.types import Elastic, Stiffness, TetMesh
from flexspline.geometry.load import load_design
from flexspline.geometry.symmetry import sector_of

SHAFT = load_design(EXAMPLES / "xb1-40.toml").part("shaft").without_holes()
MESH_S = 25.0
"""What each mesh takes on the clock of these tests."""


FINE = 2.2e-2
"""Tolerance: the first mesh leaves ± 3 %."""


@cache
def stiffness(limit_s: float, tolerance: float = FINE) -> Stiffness:
    shown = [0.0]
    sector = sector_of(SHAFT, "torsion").degrees

    def mesher(spec: MeshSpec) -> TetMesh:
        shown[0] += MESH_S
        mesh = swept_mesh(SHAFT, sector, spec)
        assert mesh is not None
        return mesh

    deadline = Deadline(limit_s, *2 * [lambda: shown[0]])
    coarse, own = first_spec(SHAFT).scaled(4.0), Elastic.of(SHAFT.material)
    meshes = MeshSequence(mesher, coarse)
    return solid_stiffness(
        meshes, FullTorsion(own, "grip"), tolerance, "", print, deadline
    ).stiffness


def test_a_mesh_that_would_end_too_late_is_not_begun() -> None:
    """25 s for the first, twice as long for the second: 75 s."""
    found = stiffness(limit_s=74.0)
    assert len(found.levels) == 1
    assert found.shortfall.of_the_machine
    assert "74 s" in found.shortfall.words


def test_one_that_would_end_in_time_is() -> None:
    assert len(stiffness(140.0).levels) > 1


def test_where_there_is_no_time_for_the_wanted_mesh_a_coarser_one_is_made() -> None:
    """A sixth of the error is wanted: the next mesh's edges are a quarter, 120 s after the first 25, or 0.4
    of its edges, 75 s."""
    cut, whole = stiffness(140.0, FINE / 6), stiffness(1000.0, FINE / 6)
    assert cut.levels[1].elements < whole.levels[1].elements
    assert cut.levels[0] == whole.levels[0]
    assert len(stiffness(74.0, FINE / 6).levels) == 1  # 50 s for the mildest


def test_a_first_mesh_that_comes_late_is_solved() -> None:
    """25 s for the mesh alone, where 10 s are allowed: its K is the answer."""
    found = stiffness(limit_s=10.0)
    assert len(found.levels) == 1
    assert found.shortfall.of_the_machine
