"""Stress of a part with holes or a keyway: that of the body without them, plus that of their effect."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import pi, radians

import numpy as np

from flexspline.fea.axisymmetric.bisection import Box
from flexspline.fea.axisymmetric.field_at_points import FieldAtPoints
from flexspline.fea.nodal_average import nodal_average
from flexspline.fea.solid.elements import basis_of, reference_values
from flexspline.fea.solid.peak import SharpEdges, Stresses, largest_of, on_lattice, outer_facets
from flexspline.fea.solid.stress import nodal_stress, von_mises
from flexspline.fea.types import Elastic, SolidField, TetMesh

HIGH_SHARE = 0.8
"""Of the largest stress that counts at a node: facets with at least that are evaluated at their lattice
points, not interpolated between nodes. On the others interpolation is no 20 % off. Judgement."""
PLANES = 8
"""Nodes nearest to a place of the meridian, in whose planes the stress there is looked at. Judgement."""


@dataclass(frozen=True)
class FieldWithoutCuts:
    """Field of the body of revolution that a part is without holes and keyway.

    Attributes
    ----------
    at : displacements (k, 3) [mm] and stresses (k, 3, 3) [MPa] at points (k, 3) [mm], all Cartesian.
    places : (j, 2) the meridian's own nodes r, z [mm], and where its own peak is.
    angles : [rad] where a harmonic is largest, up to half a turn; none where it is the same at all angles.
    """

    at: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
    places: np.ndarray
    angles: tuple[float, ...]

    @classmethod
    def of(
        cls, known: FieldAtPoints, times: float = 1.0, cuts: Sequence[Box] = ()
    ) -> FieldWithoutCuts:
        """Return a solved harmonic, or so many times it; no place is in a box, which the angles may cut."""

        def at(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            displacement, stress = known.at(points)
            return displacement * times, stress * times

        n = known.field.n
        angles = tuple(k * pi / (2 * n) for k in range(2 * n + 1)) if n else ()
        places = np.vstack([known.field.places, known.field.peak_rz])
        for box in cuts:
            low, high = np.array([box.r, box.z]).T
            places = places[~((low <= places) & (places <= high)).all(axis=1)]
        return cls(at, places, angles)


@dataclass(frozen=True)
class SuperposedField:
    """The whole field, and the stress (n, 3, 3) [MPa] at its nodes of what the cuts change alone."""

    whole: SolidField
    changed: np.ndarray


def superposed_field(
    mesh: TetMesh,
    change: np.ndarray,
    without_cuts: FieldWithoutCuts,
    material: Elastic,
    load_case: str,
    edges: SharpEdges,
) -> SuperposedField:
    """Return `stress_field`, where the field of the part without holes and keyway is known at any point.

    `change` (n, 3) [mm] is what these cuts change of the displacement. Only its stress has the mesh's error,
    which for the whole displacement is large at singular patch edges far from the cuts too: a shaft with 8
    holes in its flange had 4.32 MPa beside its grip in place of 3.57. Stresses at nodes that do not count are
    means over the elements beside them.
    """
    displacement, nodal = without_cuts.at(mesh.nodes)
    changed = nodal_stress(mesh, change, material)
    stress = changed + nodal
    facets = outer_facets(mesh)
    points, on_surface = on_lattice(mesh.nodes, facets), on_lattice(stress, facets)
    # of nodes, where nothing is interpolated: beside a singular edge interpolation is far too high
    left_out = edges.away(mesh.nodes) < edges.exclusion_mm
    counted = von_mises(stress)[~left_out].max(initial=0.0)
    of_facet = von_mises(on_surface).reshape(len(facets), -1)
    high = of_facet.max(axis=1) >= HIGH_SHARE * counted
    rows = np.repeat(high, of_facet.shape[1])
    on_surface[rows] += without_cuts.at(points[rows])[1] - on_lattice(nodal, facets[high])
    peak = largest_of(
        (
            Stresses(mesh.nodes, stress),
            Stresses(points, on_surface),
            _between_nodes(mesh, changed, ~left_out, without_cuts),
        ),
        edges,
    )
    # drawn from node to node, the stress at a singular edge would reach as far as the mesh's elements
    beside = left_out[mesh.cells].any(axis=1)
    stress[left_out] = changed[left_out] + _element_means(mesh, beside, without_cuts)[left_out]
    whole = SolidField(mesh, load_case, displacement + change, von_mises(stress), peak)
    return SuperposedField(whole, changed)


def _between_nodes(
    mesh: TetMesh, changed: np.ndarray, counted: np.ndarray, without_cuts: FieldWithoutCuts
) -> Stresses:
    """Return stresses at the meridian's own nodes, in planes of the mesh's nodes or at the angles that count.

    Beside singular edges these are much closer to each other than the mesh's. `changed` (n, 3, 3) is taken
    from the nearest node that counts, by a mask (n,).
    """
    from scipy.spatial import cKDTree

    x, y, z = mesh.nodes.T
    if without_cuts.angles:
        phi = np.array(
            [a for a in without_cuts.angles if a <= radians(mesh.sector_deg) * (1 + 1e-9)]
        )
        phi = np.broadcast_to(phi, (len(without_cuts.places), len(phi)))
    else:
        tree = cKDTree(np.stack([np.hypot(x, y), z], axis=1))
        phi = np.arctan2(y, x)[tree.query(without_cuts.places, PLANES)[1]]
    r, height = (np.broadcast_to(a[:, None], phi.shape) for a in without_cuts.places.T)
    points = np.stack([r * np.cos(phi), r * np.sin(phi), height], axis=2).reshape(-1, 3)
    near = cKDTree(mesh.nodes[counted]).query(points)[1]
    return Stresses(points, changed[counted][near] + without_cuts.at(points)[1])


def _element_means(
    mesh: TetMesh, elements: np.ndarray, without_cuts: FieldWithoutCuts
) -> np.ndarray:
    """Return the stress (n, 3, 3) at every node, as the mean over some of its elements, a mask (m,)."""
    cells = mesh.cells[elements]
    basis = basis_of(mesh.curved.mesh, np.flatnonzero(elements))
    at = np.matmul(reference_values(basis.X.T), mesh.nodes[cells])
    values = without_cuts.at(at.reshape(-1, 3))[1].reshape(*at.shape[:2], 9)
    volume = basis.dx.sum(axis=1)
    mean = np.einsum("mq,mqc->mc", basis.dx, values) / volume[:, None]
    at_nodes = np.repeat(mean[:, None], cells.shape[1], axis=1)
    nodes, numbers = np.unique(cells, return_inverse=True)
    means = np.zeros((len(mesh.nodes), 9))
    means[nodes] = nodal_average(len(nodes), 9, [(numbers.reshape(cells.shape), volume, at_nodes)])
    return means.reshape(-1, 3, 3)
