"""Hand-made meshes for known answers: a box cut into tetrahedra and bent by any smooth map."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import degrees

import numpy as np

from flexspline.fea.solid.quadratic import boundary_faces, with_middles
from flexspline.fea.types import TetMesh
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START

Where = Callable[[np.ndarray], np.ndarray]
Mapping3 = Callable[[np.ndarray], np.ndarray]


def sector_mesh(
    r: np.ndarray, phi: np.ndarray, z: np.ndarray, patches: Mapping[str, Where], shake: float = 0.0
) -> TetMesh:
    """A cylinder's sector about z; patches by predicates on (r, φ, z) (k, 3)."""
    rules: dict[str, Where] = {
        SYMMETRY_START: lambda c: np.isclose(c[:, 1], phi[0]),
        SYMMETRY_END: lambda c: np.isclose(c[:, 1], phi[-1]),
        **patches,
    }
    return bent_box(r, phi, z, from_cylindrical, rules, shake, degrees(phi[-1] - phi[0]))


def from_cylindrical(c: np.ndarray) -> np.ndarray:
    """(r, φ, z) to (x, y, z), both (n, 3)."""
    return np.column_stack([c[:, 0] * np.cos(c[:, 1]), c[:, 0] * np.sin(c[:, 1]), c[:, 2]])


def bent_box(
    a: np.ndarray, b: np.ndarray, c: np.ndarray, mapping: Mapping3, patches: Mapping[str, Where],
    shake: float = 0.0, sector_deg: float = 360.0,
) -> TetMesh:  # fmt: skip
    """Curved quadratic tetrahedra: the grid a × b × c seen through `mapping` (n, 3) → (n, 3).

    `mapping` is smooth and keeps orientation. Patches are predicates on facet centres (k, 3) of the
    straight box; where several hold, the last does. `shake` moves inner corners at random by that
    share of a cell.
    """
    from skfem import MeshTet

    box = MeshTet.init_tensor(a, b, c)
    points, tets = box.p.T.copy(), box.t.T
    if shake:
        low, high = points.min(axis=0), points.max(axis=0)
        inside = ((points > low) & (points < high)).all(axis=1)
        cell = np.array([np.diff(axis).min() for axis in (a, b, c)])
        rng = np.random.default_rng(1)
        points[inside] += rng.uniform(-shake, shake, (inside.sum(), 3)) * cell
    tets = _positive(points, tets)
    faces = boundary_faces(tets)
    edges, cells, facets = with_middles(points, tets, faces)
    straight = np.vstack([points, points[edges].mean(axis=1)])
    names = ("", *patches)
    patch = np.zeros(len(facets), int)
    centres = points[faces].mean(axis=1)
    for i, rule in enumerate(patches.values()):
        patch[rule(centres)] = i + 1
    return TetMesh(mapping(straight), cells, facets, patch, names, sector_deg)


def _positive(points: np.ndarray, tets: np.ndarray) -> np.ndarray:
    from flexspline.fea.solid.tetwild import signed_volumes

    out = tets.copy()
    flipped = signed_volumes(points, tets) < 0
    out[flipped] = out[flipped][:, [0, 2, 1, 3]]
    return out
