"""Hand-made meshes for closed forms: a box in (r, φ, z) cut into tetrahedra and bent into a sector."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import degrees

import numpy as np

from fea.solid.elements import linear_mesh
from fea.solid.mesh import boundary_faces
from fea.types import TetMesh
from geometry.surfaces import SYMMETRY_END, SYMMETRY_START

Where = Callable[[np.ndarray], np.ndarray]


def sector_mesh(
    r: np.ndarray, phi: np.ndarray, z: np.ndarray, patches: Mapping[str, Where], shake: float = 0.0
) -> TetMesh:
    """Curved quadratic tetrahedra of a cylinder's sector; patches by predicates on (r, φ, z) (k, 3).

    `shake` moves inner corners at random by that share of a cell.
    """
    from skfem import MeshTet

    box = MeshTet.init_tensor(r, phi, z)
    points, tets = box.p.T.copy(), box.t.T
    if shake:
        low, high = points.min(axis=0), points.max(axis=0)
        inside = ((points > low) & (points < high)).all(axis=1)
        cell = np.array([np.diff(a).min() for a in (r, phi, z)])
        rng = np.random.default_rng(1)
        points[inside] += rng.uniform(-shake, shake, (inside.sum(), 3)) * cell
    linear = linear_mesh(points, tets)
    tets = _positive(points, linear.t.T)
    linear = linear_mesh(points, tets)
    edges = linear.edges.T
    n = len(points)
    bent = np.vstack([points, points[edges].mean(axis=1)])
    faces = boundary_faces(tets)
    lookup = {tuple(sorted(e)): n + i for i, e in enumerate(edges.tolist())}
    sides = ((0, 1), (1, 2), (2, 0))
    middles = [[lookup[tuple(sorted((f[a], f[b])))] for a, b in sides] for f in faces.tolist()]
    facets = np.hstack([faces, np.array(middles)])
    rules: dict[str, Where] = {
        SYMMETRY_START: lambda c: np.isclose(c[:, 1], phi[0]),
        SYMMETRY_END: lambda c: np.isclose(c[:, 1], phi[-1]),
        **patches,
    }
    names = ("", *rules)
    patch = np.zeros(len(facets), int)
    centres = points[faces].mean(axis=1)
    for i, rule in enumerate(rules.values()):
        patch[rule(centres)] = i + 1
    x = np.column_stack(
        [bent[:, 0] * np.cos(bent[:, 1]), bent[:, 0] * np.sin(bent[:, 1]), bent[:, 2]]
    )
    cells = np.hstack([tets, linear.t2e.T + n])
    return TetMesh(x, cells, facets, patch, names, degrees(phi[-1] - phi[0]))


def _positive(points: np.ndarray, tets: np.ndarray) -> np.ndarray:
    from fea.solid.tetwild import signed_volumes

    out = tets.copy()
    flipped = signed_volumes(points, tets) < 0
    out[flipped] = out[flipped][:, [0, 2, 1, 3]]
    return out
