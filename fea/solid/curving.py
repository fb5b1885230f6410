"""Ten-node tetrahedra of halved elements: curved edges, bisected if they bend an element too far."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np

from flexspline.fea.errors import MeshQualityError, TooManyElementsError
from flexspline.fea.solid.bisect import Simplices, halved
from flexspline.fea.solid.bisectable import BisectableMesh
from flexspline.fea.solid.facet_surfaces import patches_of
from flexspline.fea.solid.layer_grading import with_middles_of
from flexspline.fea.solid.polar import cartesian, middles, polar
from flexspline.fea.solid.quadratic import (
    JACOBIAN_RATIO,
    straightened_inside,
    straightened_too,
    with_middles,
)
from flexspline.fea.solid.snap import middles_on_surfaces
from flexspline.fea.solid.tetwild import signed_volumes
from flexspline.geometry.surfaces import Surface

BENT_ROUNDS = 5
"""Most rounds of halving bent edges. Judgement: their number falls from round to round, else the rounds
end."""
BENT_SHARE = 0.015
"""Of an edge's length: how far its middle lies off the straight line, where halving helps: an arc of 7°
has so much. Of what loses less, a few edges may be straight within the check of areas. With twice as much, a
shaft of one segment with five holes kept six straight edges, whose neighbours were then bent too far, and
missed that check; others have at most 4 % more elements with this."""


def quadratic(
    points: np.ndarray,
    mesh: Simplices,
    surfaces: Sequence[Surface],
    sector_deg: float,
    most: float,
    in_layers: bool,
) -> BisectableMesh:
    """Ten-node tetrahedra; edges of the surface that bend one too far are halved, and straight in the end.

    Raises
    ------
    MeshQualityError : elements are flat, or bent too far nevertheless.
    TooManyElementsError : more than `most`.
    """
    if (signed_volumes(points, mesh.tets) <= 0).any():
        raise MeshQualityError("elements are flat once their nodes are on the part's surfaces")
    before = inf
    for left in reversed(range(BENT_ROUNDS + 1)):
        nodes, ratio, edges, cells, facets = _curved(points, mesh, surfaces)
        n = len(points)
        bent = np.zeros(len(edges), bool)
        bent[np.unique(cells[ratio < JACOBIAN_RATIO, 4:]) - n] = True
        bend = np.linalg.norm(nodes[n:] - points[edges].mean(axis=1), axis=1)
        length = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
        bent &= bend > BENT_SHARE * length
        if not left or not 0 < bent.sum() < before:
            break
        before = bent.sum()
        mesh, cut_edges = halved(mesh, edges, length, bent)
        if len(mesh.tets) > most:
            raise TooManyElementsError(len(mesh.tets), most)
        points = with_middles_of(points, mesh, cut_edges, surfaces)
    nodes = straightened_too(nodes, ratio, cells, edges)
    patches = patches_of(mesh.facet_surface, surfaces)
    return BisectableMesh(nodes, cells, facets, *patches, sector_deg, mesh.facet_surface, in_layers)


def _curved(
    points: np.ndarray, mesh: Simplices, surfaces: Sequence[Surface]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Nodes with middle ones, cells' `jacobian_ratio`, edges, ten-node cells and six-node facets.

    Middle nodes follow the angle, those of the boundary lie on its surfaces. Within the part edges are
    straight where elements would be bent too far, so that those of its surface may stay.
    """
    edges, cells, facets = with_middles(points, mesh.tets, mesh.facets)
    turned = cartesian(middles(polar(points)[edges]))
    nodes = middles_on_surfaces(points, turned, edges, facets, mesh.facet_surface, surfaces)
    nodes, ratio = straightened_inside(nodes, cells, edges, facets)
    return nodes, ratio, edges, cells, facets
