"""The meridian mesher: it fills the outline, keeps angles, and encloses arcs from both sides."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from example_cup import CUP
from hand_made_tube import tube

from flexspline.fea.axisymmetric.bisection import refined, refined_repeatedly
from flexspline.fea.axisymmetric.meridian_mesh import MeshingError, signed_areas
from flexspline.fea.axisymmetric.space import curved, straight
from flexspline.fea.axisymmetric.triangulate import SMALLEST_ANGLE, triangulate
from flexspline.geometry.outline import Meridian, Segment


def angles(points, triangles):
    corner = points[triangles]
    u = np.roll(corner, -1, axis=1) - corner
    v = np.roll(corner, 1, axis=1) - corner
    cross = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return np.arctan2(cross, (u * v).sum(axis=2))


def volume(points, triangles):
    return float(
        2 * pi * (signed_areas(points, triangles) * points[triangles, 0].mean(axis=1)).sum()
    )


def randomly_refined(mesh, seed: int):
    return refined(mesh, np.random.default_rng(seed).random(len(mesh.triangles)) < 0.4)


def test_first_mesh_has_the_promised_angles():
    mesh = triangulate(CUP.meridian())
    # nodes are put on arcs as edges are halved, before triangles are judged: no slack but rounding
    assert angles(mesh.points, mesh.triangles).min() > SMALLEST_ANGLE - 1e-9


def test_refinement_stays_conforming_and_well_shaped():
    mesh = triangulate(CUP.meridian())
    for seed in range(4):
        mesh = randomly_refined(mesh, seed)
        pairs = np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2)
        edges, uses = np.unique(pairs, axis=0, return_counts=True)
        assert uses.max() == 2
        rim = np.sort(mesh.edges, axis=1)
        assert {tuple(e) for e in edges[uses == 1]} == {tuple(e) for e in rim}
    # longest-edge bisection keeps at least half the first mesh's smallest angle (Rosenberg and
    # Stenger 1975); arcs move nodes a little, hence the 5 %
    assert angles(mesh.points, mesh.triangles).min() > 0.95 * SMALLEST_ANGLE / 2


def test_what_is_refined_repeatedly_is_cut_in_sixteen():
    """Of a square's even mesh the middle, and nothing else."""
    square = [(1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0)]
    ends = [*square[1:], square[0]]
    mesh = triangulate(Meridian(tuple(map(Segment, square, ends))))
    for _ in range(3):
        mesh = refined(mesh, np.ones(mesh.elements, bool))
    centre = mesh.points[mesh.triangles].mean(axis=1)
    again = np.abs(centre - (1.5, 0.5)).max(axis=1) < 0.2
    once = np.abs(centre - (1.5, 0.5)).max(axis=1) < 0.3
    finer = refined_repeatedly(mesh, [once, again])
    area = signed_areas(mesh.points, mesh.triangles).max()
    pieces = signed_areas(finer.points, finer.triangles)
    inside = np.abs(finer.points[finer.triangles].mean(axis=1) - (1.5, 0.5)).max(axis=1)
    assert pieces[inside < 0.1].max() == pytest.approx(area / 16)
    assert pieces[inside > 0.45].max() == pytest.approx(area)
    assert pieces.sum() == pytest.approx(1.0)


def test_volumes_enclose_pappus_and_close_up():
    outline = CUP.meridian()
    mesh = triangulate(outline)
    apart = []
    for _ in range(3):
        more = volume(mesh.containing(), mesh.triangles)
        less = volume(mesh.contained(), mesh.triangles)
        assert less < outline.volume < more
        apart.append(more - less)
        mesh = refined(mesh, np.ones(len(mesh.triangles), bool))
    # chord areas fall with the square of the chord; 3.5 for 4 leaves room for the arcs' end edges
    assert apart[0] / apart[2] > 3.5**2


def test_every_arc_clears_the_polygons():
    mesh = randomly_refined(randomly_refined(triangulate(CUP.meridian()), 1), 2)
    for index, s in enumerate(mesh.outline.segments):
        if s.centre is None:
            continue
        edges = mesh.edges[mesh.edge_segment == index]
        pushed = mesh.containing() if s.sweep > 0 else mesh.contained()
        a, b = pushed[edges[:, 0]] - s.centre, pushed[edges[:, 1]] - s.centre
        t = np.linspace(0, 1, 21)[:, None, None]
        distance = np.linalg.norm(a + t * (b - a), axis=2)
        assert distance.min() > s.radius * (1 - 1e-12)


def test_nodes_of_fillets_lie_on_the_arc_after_refinement():
    mesh = randomly_refined(triangulate(CUP.meridian()), 3)
    for index, s in enumerate(mesh.outline.segments):
        nodes = np.unique(mesh.edges[mesh.edge_segment == index])
        off = np.linalg.norm(mesh.points[nodes] - s.nearest(mesh.points[nodes]), axis=1)
        assert off.max() < 1e-12 * 30  # rounding at the part's size


def test_crossing_outline_is_refused():
    corners = [(1.0, 0.0), (3.0, 2.0), (3.0, 0.0), (1.0, 2.0)]
    bow = Meridian(
        tuple(Segment(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))
    )
    with pytest.raises(MeshingError):
        triangulate(bow)


def test_rectangles_turned_by_any_angle_are_filled():
    """Points of a straight edge at an angle lie on it to rounding only: flat triangles on the hull."""
    rng = np.random.default_rng(1)
    for turn in rng.uniform(0, 2 * pi, 100):
        width, height = rng.uniform(1, 5), rng.uniform(5, 60)
        x, y = np.array([(0, 0), (width, 0), (width, height), (0, height)], float).T
        c, s = np.cos(turn), np.sin(turn)
        corner = [tuple(p) for p in np.column_stack([100 + c * x - s * y, 100 + s * x + c * y])]
        outline = Meridian(tuple(Segment(corner[k - 1], corner[k]) for k in range(4)))
        mesh = triangulate(outline)
        area = signed_areas(mesh.points, mesh.triangles)
        assert area.sum() == pytest.approx(width * height, rel=1e-9)
        assert angles(mesh.points, mesh.triangles).min() > SMALLEST_ANGLE - 1e-9


def test_scikit_fem_need_not_put_large_meshes_in_order(caplog):
    """It would say so on standard error, for each mesh of more than 1000 unknowns."""
    mesh = triangulate(CUP.meridian())
    while mesh.elements < 1000:
        mesh = refined(mesh, np.ones(mesh.elements, bool))
    for space in (curved(mesh, 4), straight(mesh, mesh.points, 4, {})):
        assert space.count > 1000
    assert len(tube(360.0, 60).curved.mesh.t.T) > 1000
    assert caplog.messages == []
