"""A finer mesh by the errors of a coarser one's elements, without a mesher.

Elements with the largest errors are halved in rounds. After each, the parts have the errors that theory
promises, so that a singular edge with most of the error is refined several times in one mesh.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.fea.edges import edge_numbers
from flexspline.fea.solid.bisect import PAIRS, Simplices, halved
from flexspline.fea.solid.bisectable import BisectableMesh
from flexspline.fea.solid.curving import quadratic
from flexspline.fea.solid.layer_grading import WHOLE_STEP, with_middles_of
from flexspline.fea.solid.layered import check_layered
from flexspline.fea.solid.layers import RING_STEP
from flexspline.fea.solid.polar import polar
from flexspline.fea.solid.seams import Seams, distance_from, seams_of
from flexspline.fea.solid.swept import check_swept
from flexspline.fea.solid.swept_sizing import MOST_ELEMENTS
from flexspline.geometry.part import Part
from flexspline.geometry.surfaces import Surface, part_surfaces

LAYER_GROWTH = 0.7
"""Growth of the length about the axis beyond the length across, per distance from holes and keyway: as in a
first mesh."""
CUT = 0.7
"""Share of an element's longest edge. Shorter edges are not halved with it, so that long elements become well
shaped. Judgement."""
LEFT_AT_EDGE, LEFT_AWAY = 1 / 4, 1 / 64
"""Share of an element's squared error that each of its parts keeps. At a singular edge the sum of the errors
halves with the length (at a change of patch, the slowest case), and two or three parts stay at the edge.
Elsewhere the sum falls with the fourth power of the length in eight parts: 1/128 for each; twice that,
because half of the elements are halved along fewer edges."""
ROUND_SHARE = 0.04
"""Most elements that a round halves, as a share of all. Judgement: rounds are small because each uses the
errors that the round before is expected to leave."""
ELEMENTS_PER_HALVING = 7.0
"""Elements that one halved element adds. Its neighbours' parts come on top, so the last round is small."""
HALVING_ROUNDS = 40
"""Of halving: 2 to 3 double the elements."""


def finer_by_error(
    part: Part, mesh: BisectableMesh, error: np.ndarray, wanted: float
) -> BisectableMesh:
    """Return a mesh with `wanted` elements, with shorter edges where the elements' errors (m,) are large.

    Raises
    ------
    MeshQualityError : elements are flat or bent too far, or a size is not the part's.
    TooManyElementsError : more than MOST_ELEMENTS.
    """
    surfaces = part_surfaces(part, mesh.sector_deg)
    points, finer = _halved_by_error(mesh.corners, mesh.simplices, surfaces, error, wanted)
    made = quadratic(points, finer, surfaces, mesh.sector_deg, MOST_ELEMENTS, mesh.in_layers)
    check = check_layered if mesh.in_layers else check_swept
    check(made, part)
    return made


def _halved_by_error(
    points: np.ndarray,
    mesh: Simplices,
    surfaces: Sequence[Surface],
    error: np.ndarray,
    wanted: float,
) -> tuple[np.ndarray, Simplices]:
    """Corners (n, 3) [mm] and tetrahedra with the largest errors halved until there are `wanted` or more.

    `error` (m,) is the elements' share of the energy's, any unit; new nodes of the boundary are on its
    surfaces. A few more than wanted are made.
    """
    for _ in range(HALVING_ROUNDS):
        elements = len(mesh.tets)
        if elements >= wanted:
            break
        count = 1 + int(min(ROUND_SHARE * elements, (wanted - elements) / ELEMENTS_PER_HALVING))
        largest = np.zeros(elements, bool)
        largest[np.argpartition(error, -count)[-count:]] = True
        seams = seams_of(points, mesh.facets, mesh.facet_surface, surfaces)
        edges, lengths, of_element = _lengths(points, mesh, seams)
        mine = of_element[largest]
        marked = np.zeros(len(edges), bool)
        marked[mine[lengths[mine] > CUT * lengths[mine].max(axis=1, keepdims=True)]] = True
        finer, cut_edges = halved(mesh, edges, lengths, marked)
        points = with_middles_of(points, finer, cut_edges, surfaces)
        error = _promised(points, finer, surfaces, error, largest)
        mesh = finer
    return points, mesh


def _promised(
    points: np.ndarray,
    mesh: Simplices,
    surfaces: Sequence[Surface],
    error: np.ndarray,
    largest: np.ndarray,
) -> np.ndarray:
    """Errors of a halved mesh's elements, from those of the elements before and which of them were chosen."""
    assert mesh.parents is not None
    seams = seams_of(points, mesh.facets, mesh.facet_surface, surfaces)
    singular = np.zeros(len(points), bool)
    singular[seams.nodes[seams.singular]] = True
    left = np.where(singular[mesh.tets].any(axis=1), LEFT_AT_EDGE, LEFT_AWAY)
    parts = np.bincount(mesh.parents)[mesh.parents]
    return np.asarray(error[mesh.parents] * np.where(largest[mesh.parents], left, 1 / parts))


def _lengths(
    points: np.ndarray, mesh: Simplices, seams: Seams
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges (e, 2), their lengths (e,) [mm], and the numbers (m, 6) of each element's edges.

    About the axis they count for less with the distance from holes and keyway.
    """
    edges = mesh.edges()
    of_element = np.searchsorted(
        edge_numbers(edges, len(points)), edge_numbers(mesh.tets[:, PAIRS], len(points))
    )
    ends = polar(points)[edges]
    dr, turn, dz = (ends[:, 1] - ends[:, 0]).T
    turn = np.where((ends[:, :, 0] > 0).all(axis=1), turn, 0.0)
    r = ends[:, :, 0].mean(axis=1)
    meridian = np.hypot(dr, dz)
    across = np.full(len(edges), np.inf)
    np.minimum.at(across, of_element, meridian[of_element].max(axis=1, keepdims=True))
    away = distance_from(seams.nodes[seams.singular & ~seams.revolved], points, points)
    away = away[edges].mean(axis=1)
    around = np.minimum(across + LAYER_GROWTH * away, WHOLE_STEP * RING_STEP * r)
    share = np.divide(across, around, out=np.ones_like(r), where=around > across)
    return edges, np.hypot(meridian, r * turn * share), of_element
