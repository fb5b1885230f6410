"""The largest von Mises stress outside the excluded zones, at nodes and between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import inf
from typing import Any

import numpy as np

from flexspline.fea.axisymmetric.harmonics import HarmonicModel
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.recovery import mises_parts
from flexspline.fea.quadratic_triangle import lattice_values
from flexspline.fea.stress_rule import Largest
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.outline import Meridian

LATTICE_STEPS = 8
"""Steps along each side of a triangle of the lattice on which stress is evaluated. The top of a parabola is
missed by at most 1/64 of its height over the side."""


BULGE = 1.25
"""No point of a curved triangle is farther from a corner than this times its farthest node: the chords of
a fillet open by 15° at most."""


class StressError(ComputationError):
    """No stress can be reported."""


@dataclass(frozen=True)
class MeridianPeak:
    """The largest von Mises stress beyond the excluded distance.

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
class _PeakPoint:
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
    s, values = model.space, lattice_values(LATTICE_STEPS)
    lattice, rim = _Lattice(model), _OutlineEdges(model)
    acting = np.flatnonzero(nodal.any(axis=0))
    parts = mises_parts({int(k): nodal[s.dofs, k] @ values for k in acting})
    either = np.maximum(*parts)

    def search(distance_mm: float, at: np.ndarray, within_mm: float) -> _PeakPoint | None:
        counts = lattice.counting(distance_mm)
        if within_mm < inf:
            counts &= np.linalg.norm(lattice.places - at, axis=2) <= within_mm
        if not counts.any():
            return None
        top = np.unravel_index(np.where(counts, either, 0.0).argmax(), either.shape)
        best, place = float(either[top]), lattice.places[top]
        at_sine = bool(parts[1][top] > parts[0][top])
        for rim_place, rim_stress in rim.crossings(nodal, distance_mm):
            direct, shear = mises_parts(dict(enumerate(rim_stress)))
            if max(direct, shear) > best and np.linalg.norm(rim_place - at) <= within_mm:
                best, place = float(max(direct, shear)), rim_place
                at_sine = bool(shear > direct)
        return _PeakPoint(best, place, at_sine, counts)

    peak = search(exclusion_mm, np.zeros(2), inf)
    if peak is None:
        raise StressError(f"no point of the part is {exclusion_mm:g} mm away from its sharp edges")
    peak_at = peak.place

    def largest(distance_mm: float, within_mm: float = inf) -> float | None:
        other = search(distance_mm, peak_at, within_mm)
        return None if other is None else float(np.sqrt(other.square))

    return MeridianPeak(
        float(np.sqrt(peak.square)),
        (float(peak.place[0]), float(peak.place[1])),
        peak.at_sine,
        np.asarray(peak.counts.any(axis=1)),
        np.sqrt(np.where(peak.counts, either, 0.0).max(axis=1)),
        np.sqrt(either.max(axis=1)),
        largest,
    )


def coarse_at_border(mesh: MeridianMesh, exclusion_mm: float) -> np.ndarray:
    """Mask (m,) of triangles too large to keep the singular stresses within the distance.

    A triangle that reached from the singular point past the distance would carry its false peak
    along; so those near by may be no larger than half of it.
    """
    corner = mesh.points[mesh.triangles]
    longest = mesh.longest_edges()
    # nodes at the border average over triangles that begin up to half a distance beyond it
    coarse = longest > exclusion_mm / 2
    near = _distance(corner[coarse], mesh.outline).min(axis=1) < 1.5 * exclusion_mm
    coarse[coarse] = near
    return np.asarray(coarse)


@lru_cache(maxsize=2)
def _singular(outline: Meridian) -> Any:
    """A tree of the sharp corners and patch edges."""
    from scipy.spatial import cKDTree

    return cKDTree(np.array([*outline.sharp_corners, *outline.patch_edges]))


def _distance(places: np.ndarray, outline: Meridian) -> np.ndarray:
    """To the nearest sharp corner or patch edge."""
    return np.asarray(_singular(outline).query(places)[0])


class _Lattice:
    """The lattice points of all triangles, and how far they are from what is singular."""

    def __init__(self, model: HarmonicModel) -> None:
        nodes = model.space.places[model.space.dofs]
        self._outline = model.mesh.outline
        self._corner = _distance(nodes[:, 0], self._outline)
        self._reach = BULGE * np.linalg.norm(nodes - nodes[:, :1], axis=2).max(axis=1)
        self.places = np.matmul(lattice_values(LATTICE_STEPS).T, nodes)

    def counting(self, distance_mm: float) -> np.ndarray:
        """Mask (m, q) of the points at the distance or farther.

        Most triangles lie wholly on one side of it; only the others' points are looked at.
        """
        # a point at the distance but for rounding is at the distance
        limit = distance_mm * (1 - 1e-9)
        counts = np.repeat((self._corner > limit)[:, None], self.places.shape[1], axis=1)
        split = np.abs(self._corner - limit) <= self._reach
        counts[split] = _distance(self.places[split], self._outline) >= limit
        return counts


class _OutlineEdges:
    """The outline's edges, and how far their points are from what is singular."""

    def __init__(self, model: HarmonicModel) -> None:
        self._edges = model.space.rim
        self._nodes = model.space.places[self._edges]
        shape = _edge_shape(np.linspace(0, 1, LATTICE_STEPS + 1))
        self._away = _distance(np.einsum("qi,kid->kqd", shape, self._nodes), model.mesh.outline)

    def crossings(
        self, nodal: np.ndarray, distance_mm: float
    ) -> list[tuple[np.ndarray, np.ndarray]]:
        """Places and stresses where the outline leaves the excluded neighbourhoods."""
        beyond = self._away - distance_mm
        edge, step = np.nonzero(beyond[:, 1:] * beyond[:, :-1] < 0)
        before, after = beyond[edge, step], beyond[edge, step + 1]
        crossing = _edge_shape((step + before / (before - after)) / LATTICE_STEPS)
        places = np.einsum("ki,kid->kd", crossing, self._nodes[edge])
        stresses = np.einsum("ki,kic->kc", crossing, nodal[self._edges[edge]])
        return list(zip(places, stresses, strict=True))


def _edge_shape(t: np.ndarray) -> np.ndarray:
    """Quadratic shape functions of start, end and middle at t in [0, 1]: (q, 3)."""
    return np.column_stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)])
