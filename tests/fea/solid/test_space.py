"""scikit-fem's named boundaries of a solid mesh hold the nodes that the mesh's own facets have."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hand_made_tube import tube

from flexspline.fea.solid.space import SolidSpace
from flexspline.fea.solid.unfold import unfolded
from flexspline.fea.types import TetMesh


def shuffled(mesh: TetMesh) -> TetMesh:
    """The same mesh, its middle nodes numbered by lot."""
    corners = int(mesh.cells[:, :4].max()) + 1
    number = np.arange(len(mesh.nodes))
    number[corners:] = np.random.default_rng(3).permutation(number[corners:])
    nodes = np.empty_like(mesh.nodes)
    nodes[number] = mesh.nodes
    return replace(mesh, nodes=nodes, cells=number[mesh.cells], facets=number[mesh.facets])


MESHES = {
    "a sector": tube(30.0, 2),
    "unfolded": unfolded(tube(30.0, 2), 90.0),
    "numbered by lot": shuffled(tube(30.0, 2)),
    "closed": tube(360.0, 24),
}


@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES.keys())
def test_a_boundary_has_the_nodes_of_its_facets(mesh: TetMesh) -> None:
    space = SolidSpace.of(mesh)
    assert np.array_equal(space.curved.doflocs.T, mesh.nodes[space.node])
    assert np.array_equal(space.node[space.curved.dofs.element_dofs.T], mesh.cells)
    for patch in filter(None, mesh.patches):
        assert np.array_equal(space.on(patch), np.unique(mesh.on(patch)))


def test_a_patch_that_a_part_does_not_have_is_empty() -> None:
    assert len(SolidSpace.of(tube(30.0, 2)).on("grip")) == 0
