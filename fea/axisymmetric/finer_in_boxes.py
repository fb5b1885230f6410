"""A figure solved repeatedly on meridian meshes that are refined in boxes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import count
from typing import Protocol

from flexspline.fea.axisymmetric.bisection import Box, refined_within
from flexspline.fea.axisymmetric.marking import MOST_TRIANGLES
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.deadline import Deadline
from flexspline.fea.refinement import Refinable, refine
from flexspline.fea.types import Shortfall


class OnMeridian(Refinable[MeridianMesh], Protocol):
    """A figure that knows the mesh it was solved on last."""

    mesh: MeridianMesh


def finer_in_boxes(
    figure: OnMeridian,
    mesh: MeridianMesh,
    boxes: Sequence[Box],
    deadline: Deadline,
    most_triangles: int,
) -> Iterator[Shortfall]:
    """`refine` from a mesh with edges as the boxes ask, then with edges half as long there, and so on.

    The shortfall after each, until a third mesh, or a later one, would begin with more than `most_triangles`.

    Raises
    ------
    OutOfTimeError, and what `figure.solve` raises.
    """
    for number in count():
        mesh = refined_within(mesh, boxes, 0.5**number)
        if number > 1 and mesh.elements > most_triangles:
            return
        yield refine(figure, mesh, deadline, MOST_TRIANGLES)
        mesh = figure.mesh
