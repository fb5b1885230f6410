"""The largest von Mises stress among the points that count, looked for between nodes as well."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import inf

import numpy as np

from flexspline.fea.axisymmetric.harmonics import HarmonicModel
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh, edge_lengths
from flexspline.fea.axisymmetric.recovery import mises_parts
from flexspline.fea.axisymmetric.space import shape_functions
from flexspline.fea.stress_rule import Largest
from flexspline.geometry.errors import ComputationError

LATTICE_STEPS = 8
"""Stress is looked at on a lattice of so many steps along each side of a triangle."""


BULGE = 1.25
"""No point of a curved triangle is farther from a corner than this times its farthest node: the chords of
a fillet open by 15° at most."""


class StressError(ComputationError):
    """No stress can be reported."""


@dataclass(frozen=True)
class MeridianPeak:
    """Largest von Mises stress that counts.

    Attributes
    ----------
    mises_MPa : its value.
    rz : its place on the meridian [mm].
    at_sine : whether it stands where sin² nφ = 1 rather than cos² nφ = 1.
    counted : (m,) mask of triangles with a point that counts.
    local_mises : (m,) largest value that counts in each triangle, 0 if none [MPa].
    anywhere : (m,) largest value in each triangle, at points that do not count too [MPa].
    largest : the largest value at other distances from sharp corners and patch edges.
    """

    mises_MPa: float
    rz: tuple[float, float]
    at_sine: bool
    counted: np.ndarray
    local_mises: np.ndarray
    anywhere: np.ndarray
    largest: Largest


@dataclass(frozen=True)
class _Found:
    """Largest squared stress at a distance, where, and which lattice points (m, q) count."""

    square: float
    place: np.ndarray
    at_sine: bool
    counts: np.ndarray


def peak_stress(model: HarmonicModel, nodal: np.ndarray, exclusion_mm: float) -> MeridianPeak:
    """Search all angles and all points at least `exclusion_mm` from sharp corners and patch edges.

    The squared stress is A cos² nφ + B sin² nφ, so the largest over φ is the larger of A and B.
    Beside the lattice, the points of the outline at exactly that distance are looked at: there
    the stress is often largest.

    Raises
    ------
    StressError
        If no point is that far away.
    """
    s, singular = model.space, _singular(model.mesh)
    values = _lattice_values()
    acting = np.flatnonzero(nodal.any(axis=0))
    parts = mises_parts({int(k): nodal[s.dofs, k] @ values for k in acting})
    either = np.maximum(*parts)

    places = np.matmul(values.T, s.places[s.dofs])

    def search(distance_mm: float, at: np.ndarray, within_mm: float) -> _Found | None:
        counts = _counting(s.places[s.dofs], values, singular, distance_mm)
        if within_mm < inf:
            counts &= np.linalg.norm(places - at, axis=2) <= within_mm
        if not counts.any():
            return None
        top = np.unravel_index(np.where(counts, either, 0.0).argmax(), either.shape)
        best, place, at_sine = float(either[top]), places[top], bool(parts[1][top] > parts[0][top])
        for rim_place, rim_stress in _at_distance(model, nodal, singular, distance_mm):
            direct, shear = mises_parts(dict(enumerate(rim_stress)))
            if max(direct, shear) > best and np.linalg.norm(rim_place - at) <= within_mm:
                best, place = float(max(direct, shear)), rim_place
                at_sine = bool(shear > direct)
        return _Found(best, place, at_sine, counts)

    found = search(exclusion_mm, np.zeros(2), inf)
    if found is None:
        raise StressError(f"no point of the part is {exclusion_mm:g} mm away from its sharp edges")
    peak_at = found.place

    def largest(distance_mm: float, within_mm: float = inf) -> float | None:
        other = search(distance_mm, peak_at, within_mm)
        return None if other is None else float(np.sqrt(other.square))

    return MeridianPeak(
        float(np.sqrt(found.square)),
        (float(found.place[0]), float(found.place[1])),
        found.at_sine,
        np.asarray(found.counts.any(axis=1)),
        np.sqrt(np.where(found.counts, either, 0.0).max(axis=1)),
        np.sqrt(either.max(axis=1)),
        largest,
    )


def coarse_at_border(mesh: MeridianMesh, exclusion_mm: float) -> np.ndarray:
    """Mask (m,) of triangles too large to keep the singular stresses within the distance.

    A triangle that reached from the singular point past the distance would carry its false peak
    along; so those near by may be no larger than half of it.
    """
    corner = mesh.points[mesh.triangles]
    longest = edge_lengths(mesh.points, mesh.triangles).max(axis=1)
    # nodes at the border average over triangles that begin up to half a distance beyond it
    coarse = longest > exclusion_mm / 2
    coarse[coarse] = _distance(corner[coarse], _singular(mesh)).min(axis=1) < 1.5 * exclusion_mm
    return np.asarray(coarse)


def _singular(mesh: MeridianMesh) -> np.ndarray:
    return np.array([*mesh.outline.sharp_corners, *mesh.outline.patch_edges])


@cache
def _lattice_values() -> np.ndarray:
    """Shape functions (6, q) on the lattice."""
    i, j = np.meshgrid(np.arange(LATTICE_STEPS + 1), np.arange(LATTICE_STEPS + 1), indexing="ij")
    inside = i + j <= LATTICE_STEPS
    return shape_functions(np.stack([i[inside], j[inside]]) / LATTICE_STEPS)


def _counting(
    nodes: np.ndarray, values: np.ndarray, singular: np.ndarray, exclusion_mm: float
) -> np.ndarray:
    """Mask (m, q) of lattice points at the distance or farther; nodes (m, 6, 2).

    Most triangles lie wholly on one side of it; only the others' points are looked at.
    """
    # a point at the distance but for rounding is at the distance
    limit = exclusion_mm * (1 - 1e-9)
    corner = _distance(nodes[:, 0], singular)
    reach = BULGE * np.linalg.norm(nodes - nodes[:, :1], axis=2).max(axis=1)
    counts = np.repeat((corner > limit)[:, None], values.shape[1], axis=1)
    split = np.abs(corner - limit) <= reach
    places = np.matmul(values.T, nodes[split])
    counts[split] = _distance(places, singular) >= limit
    return counts


def _distance(places: np.ndarray, singular: np.ndarray) -> np.ndarray:
    """To the nearest of the singular points."""
    from scipy.spatial import cKDTree

    return cKDTree(singular).query(places)[0]


def _at_distance(
    model: HarmonicModel, nodal: np.ndarray, singular: np.ndarray, exclusion_mm: float
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Places and stresses where the outline leaves the excluded neighbourhoods."""
    s = model.space
    t = np.linspace(0, 1, LATTICE_STEPS + 1)
    shape = _edge_shape(t)
    beyond = _distance(np.einsum("qi,kid->kqd", shape, s.places[s.rim]), singular) - exclusion_mm
    edge, step = np.nonzero(beyond[:, 1:] * beyond[:, :-1] < 0)
    before, after = beyond[edge, step], beyond[edge, step + 1]
    crossing = _edge_shape((step + before / (before - after)) / LATTICE_STEPS)
    places = np.einsum("ki,kid->kd", crossing, s.places[s.rim[edge]])
    stresses = np.einsum("ki,kic->kc", crossing, nodal[s.rim[edge]])
    return list(zip(places, stresses, strict=True))


def _edge_shape(t: np.ndarray) -> np.ndarray:
    """Quadratic shape functions of start, end and middle at t in [0, 1]: (q, 3)."""
    return np.column_stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)])
