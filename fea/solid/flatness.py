"""How flat a mesh's elements are: an iteration that smooths node by node is slow in flat ones."""

from __future__ import annotations

import numpy as np

from flexspline.fea.solid.tetwild import signed_volumes
from flexspline.fea.types import TetMesh

FACES = ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3))
FLAT_ASPECT, FLAT_SHARE = 150.0, 0.1
"""Longest edge over thickness of a flat element, and the share of such ones that makes an iteration slow. The
flattest tenth of shafts' meshes had 4 to 55 where it took 10 to 68 steps, 70 to 103 where 100, and 255 to 418
where 246 to 334."""


def mostly_flat(mesh: TetMesh) -> bool:
    """Whether an iteration on the mesh is expected to take longer than factors."""
    return bool(np.mean(aspects(mesh) > FLAT_ASPECT) > FLAT_SHARE)


def aspects(mesh: TetMesh) -> np.ndarray:
    """Longest edge over thickness (m,) of the elements' straight tetrahedra, 1.22 of a regular one."""
    tets = mesh.cells[:, :4]
    corner = mesh.nodes[tets]
    longest = np.max(
        [np.linalg.norm(corner - np.roll(corner, k, axis=1), axis=2).max(axis=1) for k in (1, 2)],
        axis=0,
    )
    sides = [(corner[:, b] - corner[:, a], corner[:, c] - corner[:, a]) for a, b, c in FACES]
    largest = np.max([np.linalg.norm(np.cross(*two), axis=1) / 2 for two in sides], axis=0)
    return longest * largest / (3 * signed_volumes(mesh.nodes, tets))
