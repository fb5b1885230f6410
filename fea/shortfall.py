"""Why a refinement ended before its tolerance was met: clauses that stand after a figure's bounds.

What was computed until then is given all the same; the clause travels with it (`Stiffness.shortfall`,
`StressPeak.shortfall`).
"""

from __future__ import annotations

from flexspline.fea.deadline import OutOfTimeError
from flexspline.fea.solid.errors import MemoryShortError, MesherTimeError
from flexspline.fea.types import Stiffness, StressPeak
from flexspline.geometry.errors import ComputationError

NOT_FINISHED = "the next, finer mesh was not finished:"


class ToleranceError(ComputationError):
    """A figure is of use only within its tolerance, and is not; the message says why."""


def settled(found: Stiffness) -> Stiffness:
    """A stiffness within the tolerance that was asked for.

    Raises
    ------
    ToleranceError : it is not.
    """
    if found.shortfall:
        raise ToleranceError(f"K is known to ± {found.half_width:.2g} only: {found.shortfall}")
    return found


def settled_peak(found: StressPeak) -> StressPeak:
    """A peak that stays within its tolerance on finer meshes: it has no bounds to say how far it may move.

    Raises
    ------
    ToleranceError : nobody knows.
    """
    if found.shortfall:
        raise ToleranceError(f"the peak stress may still change: {found.shortfall}")
    return found


def next_mesh_failed(fault: Exception) -> str:
    """The mesh after the last good one could not be made or solved, or not in time."""
    if isinstance(fault, OutOfTimeError | MesherTimeError | MemoryShortError):
        return f"{NOT_FINISHED} {fault}"
    if isinstance(fault, MemoryError):
        return f"{NOT_FINISHED} not enough memory {fault}".rstrip()
    return f"the next, finer mesh failed: {fault}"


def of_the_machine(shortfall: str) -> bool:
    """Whether more time or memory would have gone further: another machine, or an idle one."""
    return shortfall.startswith(NOT_FINISHED)


def largest_mesh(elements: int, most: int) -> str:
    """The next mesh would have more elements than allowed."""
    return f"the mesh has {elements} elements, and none is refined beyond {most}"


def last_mesh(meshes: int) -> str:
    """So many meshes are solved and no more."""
    return f"{meshes} mesh{'es' if meshes > 1 else ''} solved, and no more are made"
