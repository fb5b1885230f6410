"""A sector of a tube in curved quadratic tetrahedra, made by hand: its sizes are known."""

from itertools import permutations

import numpy as np

from flexspline.fea.types import SolidField, StressPeak, TetMesh
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START

INNER, OUTER, LENGTH = 8.0, 10.0, 12.0
RING_START = 8.0
PATCHES = ("", SYMMETRY_START, SYMMETRY_END, "mount", "mesh", "seat")
EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
OPPOSITE = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))


def tube(sector_deg: float, around: int, along: int = 6) -> TetMesh:
    """Every brick of a (2, around, along) grid in r, φ, z cut into six tetrahedra (Kuhn)."""
    r = np.linspace(INNER, OUTER, 3)
    phi = np.linspace(0, np.radians(sector_deg), around + 1)
    z = np.linspace(0, LENGTH, along + 1)
    closed = sector_deg == 360
    count = (3, around if closed else around + 1, along + 1)
    polar = np.stack(np.meshgrid(r, phi[: count[1]], z, indexing="ij"), -1).reshape(-1, 3)
    corners = []
    for i, j, k in np.ndindex(2, around, along):
        for order in permutations(range(3)):
            at = np.array([i, j, k])
            path = [at.copy()]
            for axis in order:
                at[axis] += 1
                path.append(at.copy())
            tet = [np.ravel_multi_index((p[0], p[1] % count[1], p[2]), count) for p in path]
            even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
            corners.append(tet if even else [tet[0], tet[2], tet[1], tet[3]])
    return _quadratic(polar, np.array(corners), sector_deg)


def _quadratic(polar: np.ndarray, tets: np.ndarray, sector_deg: float) -> TetMesh:
    pairs = np.sort(tets[:, EDGES].reshape(-1, 2), axis=1)
    unique, inverse = np.unique(pairs, axis=0, return_inverse=True)
    ends = polar[unique]
    middle = ends.mean(axis=1)
    wraps = np.abs(ends[:, 0, 1] - ends[:, 1, 1]) > np.pi  # across angle 0 of the closed tube
    middle[wraps, 1] += np.pi
    cells = np.column_stack([tets, len(polar) + inverse.reshape(-1, 6)])
    nodes = np.concatenate([polar, middle])
    number = {tuple(pair): len(polar) + i for i, pair in enumerate(unique)}
    faces = tets[:, OPPOSITE].reshape(-1, 3)
    _, first, times = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    outside = faces[first[times == 1]]
    facets = np.array(
        [[*f, *(number[tuple(sorted((f[a], f[b])))] for a, b in EDGES[:3])] for f in outside]
    )
    patch = np.array([_patch(nodes[f], sector_deg) for f in outside])
    return TetMesh(_cartesian(nodes), cells, facets, patch, PATCHES, sector_deg)


def _patch(p: np.ndarray, sector_deg: float) -> int:
    r, phi, z = p.T
    on = {
        SYMMETRY_START: sector_deg < 360 and np.allclose(phi, 0),
        SYMMETRY_END: sector_deg < 360 and np.allclose(phi, np.radians(sector_deg)),
        "mount": np.allclose(z, 0),
        "mesh": np.allclose(r, OUTER) and z.min() > RING_START - 1e-9,
        "seat": np.allclose(r, INNER) and z.min() > RING_START - 1e-9,
    }
    return next((PATCHES.index(name) for name, hit in on.items() if hit), 0)


def _cartesian(polar: np.ndarray) -> np.ndarray:
    r, phi, z = polar.T
    return np.column_stack([r * np.cos(phi), r * np.sin(phi), z])


def twisted(nodes: np.ndarray, rate: float = 1e-4) -> np.ndarray:
    """Displacement of pure torsion, u_θ = rate·r·z."""
    x, y, z = nodes.T
    return rate * np.column_stack([-y * z, x * z, 0 * z])


def oval(nodes: np.ndarray, w0: float = 0.2) -> np.ndarray:
    """Radial w0 cos 2φ that grows along the tube, tangential part of an inextensible ring."""
    x, y, z = nodes.T
    phi = np.arctan2(y, x)
    radial, around = w0 * np.cos(2 * phi), -w0 / 2 * np.sin(2 * phi)
    c, s = np.cos(phi), np.sin(phi)
    return (
        np.column_stack([radial * c - around * s, radial * s + around * c, 0 * z])
        * (z / LENGTH)[:, None]
    )


def field(mesh: TetMesh, displacement: np.ndarray, at: tuple[float, float, float]) -> SolidField:
    """A field whose stress grows with radius and height, and whose peak is said to be at `at`."""
    r = np.hypot(mesh.nodes[:, 0], mesh.nodes[:, 1])
    mises = r / OUTER + mesh.nodes[:, 2] / LENGTH
    peak = StressPeak(1.9, at, "the rim", 0.5, False, 1.5)
    return SolidField(mesh, "made by hand", displacement, mises, peak)


def corner_volumes(nodes: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Signed volumes of the straight tetrahedra."""
    a, b, c, d = (nodes[cells[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
