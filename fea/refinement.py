"""Solves on finer and finer meshes until the tolerance is met: the common loop of all models.

A mesh after the first that cannot be made or solved, or not in time, costs itself only: the answer is that
of the meshes before it, and the shortfall says why there is no better one.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from typing import Protocol, TypeVar

from flexspline.fea.deadline import NO_DEADLINE, Deadline, Pace
from flexspline.fea.shortfall import largest_mesh, last_mesh, next_mesh_failed
from flexspline.fea.types import MET, Shortfall
from flexspline.geometry.errors import ComputationError


class SizedMesh(Protocol):
    """A mesh that knows its number of elements."""

    @property
    def elements(self) -> int: ...


M = TypeVar("M", bound=SizedMesh)


class Refinable(Protocol[M]):
    """A figure, or a field, that each mesh gives better than the one before; it keeps what it found."""

    def solve(self, mesh: M) -> None:
        """Solve on one more mesh; where this raises, what was found before must still stand."""

    @property
    def met(self) -> bool:
        """Whether the meshes solved so far give the tolerance that is wanted."""

    def finer(self, mesh: M) -> M | None:
        """The mesh after the one that was solved last; None: no more are made."""


def refinements(
    model: Refinable[M], mesh: M, deadline: Deadline = NO_DEADLINE, most_elements: float = inf
) -> Iterator[Shortfall]:
    """Refine as `refine` does; yield the shortfall after each mesh, MET where there is none as yet.

    The last one is the refinement's; the mesh before may have been seen already, without it.
    """
    pace = Pace(deadline)
    pace.begin(mesh.elements)
    model.solve(mesh)
    meshes = 1
    while not model.met:
        if mesh.elements > most_elements:
            yield largest_mesh(mesh.elements, int(most_elements))
            return
        yield MET
        try:
            next_mesh = model.finer(mesh)
            if next_mesh is not None:
                pace.begin(next_mesh.elements)
                model.solve(next_mesh)
        except (ComputationError, MemoryError) as fault:
            yield next_mesh_failed(fault)
            return
        if next_mesh is None:
            yield last_mesh(meshes)
            return
        mesh, meshes = next_mesh, meshes + 1
    yield MET


def refine(
    model: Refinable[M], mesh: M, deadline: Deadline = NO_DEADLINE, most_elements: float = inf
) -> Shortfall:
    """Solve on `mesh` and on finer ones until the tolerance is met; return why, where it was not.

    Parameters
    ----------
    deadline : a mesh whose solve would end after it is not begun.
    most_elements : a mesh with more of them is the last one.

    Raises
    ------
    OutOfTimeError, and what `model.solve` raises : of the first mesh.
    """
    *_, shortfall = refinements(model, mesh, deadline, most_elements)
    return shortfall
