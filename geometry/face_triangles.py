"""Triangulation of CAD faces by the CAD kernel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flexspline.geometry.errors import GeometryError

if TYPE_CHECKING:
    import cadquery as cq


def mesh_faces(shape: cq.Shape, chord_error: float) -> None:
    """Triangulate all faces at once, so that neighbours share their edges' points."""
    from OCP.BRepMesh import BRepMesh_IncrementalMesh

    turn = 0.2  # rad: some 31 chords around, however small a fillet or a hole
    BRepMesh_IncrementalMesh(shape.wrapped, chord_error, False, turn, False)


def triangles_of(face: cq.Face) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and triangles (m, 3) of a face that `mesh_faces` has triangulated."""
    from OCP.BRep import BRep_Tool
    from OCP.TopAbs import TopAbs_REVERSED
    from OCP.TopLoc import TopLoc_Location

    where = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face.wrapped, where)
    if mesh is None:
        raise GeometryError("the CAD kernel could not triangulate a face")
    move = where.Transformation()
    nodes = (mesh.Node(i + 1).Transformed(move) for i in range(mesh.NbNodes()))
    vertices = np.array([(p.X(), p.Y(), p.Z()) for p in nodes])
    triangles = np.array([mesh.Triangle(i + 1).Get() for i in range(mesh.NbTriangles())]) - 1
    if face.wrapped.Orientation() == TopAbs_REVERSED:
        triangles = triangles[:, ::-1]
    return vertices, triangles


def inside_point(face: cq.Face) -> np.ndarray:
    """A point (1, 3) off the face's edges, on its surface though not always in its bounds."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.TopLoc import TopLoc_Location

    mesh = BRep_Tool.Triangulation_s(face.wrapped, TopLoc_Location())
    corners = [mesh.UVNode(i) for i in mesh.Triangle(1).Get()]
    u, v = (sum(c.Coord()[k] for c in corners) / 3 for k in (0, 1))
    p = BRepAdaptor_Surface(face.wrapped).Value(u, v)
    return np.array([[p.X(), p.Y(), p.Z()]])


def triangles_of_all(faces: list[cq.Face], chord_error: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) [mm] and triangles (m, 3) of loose faces, within `chord_error` [mm]."""
    vertices, triangles, count = [np.empty((0, 3))], [np.empty((0, 3), np.int64)], 0
    for face in faces:
        mesh_faces(face, chord_error)
        v, t = triangles_of(face)
        vertices.append(v)
        triangles.append(t + count)
        count += len(v)
    return np.concatenate(vertices), np.concatenate(triangles)
