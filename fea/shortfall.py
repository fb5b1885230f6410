"""Reasons why a refinement ended before its tolerance was met, printed after a figure's bounds.

What was computed until then is given all the same; the clause travels with it (`Stiffness.shortfall`,
`StressPeak.shortfall`).
"""

from __future__ import annotations

from flexspline.fea.deadline import OutOfTimeError
from flexspline.fea.errors import MemoryShortError, MesherTimeError
from flexspline.fea.types import Shortfall, Stiffness, StressPeak
from flexspline.geometry.errors import ComputationError, FlexsplineError


class ToleranceError(ComputationError):
    """A figure is of use only within its tolerance, and is not; `shortfall` says why."""

    def __init__(self, what: str, shortfall: Shortfall) -> None:
        self.shortfall = shortfall
        super().__init__(f"{what}: {shortfall}")


def settled(K: Stiffness) -> Stiffness:
    """Return the stiffness, if it is within the tolerance that was asked for.

    Raises
    ------
    ToleranceError : it is not.
    """
    if K.shortfall:
        raise ToleranceError(f"K is known to ± {K.half_width:.2g} only", K.shortfall)
    return K


def settled_peak(peak: StressPeak) -> StressPeak:
    """Return the peak, if it is within its tolerance; a peak has no bounds that say how far it may move.

    Raises
    ------
    ToleranceError : nobody knows.
    """
    if peak.shortfall:
        raise ToleranceError("the peak stress may still change", peak.shortfall)
    return peak


def missing_because(fault: FlexsplineError | MemoryError) -> Shortfall:
    """Return the reason of a figure that is missing because of this fault."""
    return Shortfall(_words(fault), _is_of_the_machine(fault))


def next_mesh_failed(fault: Exception) -> Shortfall:
    """The mesh after the last good one could not be made or solved, or not in time."""
    mended = _is_of_the_machine(fault)
    said = "was not finished" if mended else "failed"
    return Shortfall(f"the next, finer mesh {said}: {_words(fault)}", mended)


def _words(fault: Exception) -> str:
    """Python's own MemoryError may have none."""
    return f"not enough memory {fault}".rstrip() if isinstance(fault, MemoryError) else str(fault)


def _is_of_the_machine(fault: Exception) -> bool:
    if isinstance(fault, ToleranceError):
        return fault.shortfall.of_the_machine
    return isinstance(fault, OutOfTimeError | MesherTimeError | MemoryShortError | MemoryError)


def largest_mesh(elements: int, most: int) -> Shortfall:
    """The mesh has more elements than one that is refined."""
    return Shortfall(
        f"a mesh of more than {most} elements is not refined, and this one has {elements}"
    )


def last_mesh(meshes: int) -> Shortfall:
    """The given number of meshes is solved, and there are no more."""
    solved = "1 mesh" if meshes == 1 else f"{meshes} meshes"
    return Shortfall(f"no finer mesh is made of this part for this load case, after {solved}")
