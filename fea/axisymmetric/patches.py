"""The held, driven and free parts of a meridian's outline."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.geometry.errors import FlexsplineError
from flexspline.geometry.outline import Meridian


class PatchError(FlexsplineError, ValueError):
    """The outline's patches do not make the problem asked for."""


@dataclass(frozen=True)
class Boundary:
    """The outline's segments sorted into held, driven and pieces of free boundary.

    Attributes
    ----------
    held, driven : indices of segments.
    piece : (segments,) number of each segment's free piece; -1 on held and driven segments.
    pieces : how many free pieces there are.
    jump : (pieces,) coefficient of each piece's constant in T/2π.
    axis : number of the piece that contains the axis, or -1.
    """

    held: np.ndarray
    driven: np.ndarray
    piece: np.ndarray
    pieces: int
    jump: np.ndarray
    axis: int


def sorted_boundary(outline: Meridian, driven: str) -> Boundary:
    """Walk once around the outline, starting where a free piece begins.

    Raises
    ------
    PatchError
        If a patch is missing, is curved, or the two touch.
    """
    segments = outline.segments
    role = [{"mount": "held", driven: "driven"}.get(s.patch or "", "free") for s in segments]
    for wanted, name in (("held", "mount"), ("driven", driven)):
        mine = [s for s, kind in zip(segments, role, strict=True) if kind == wanted]
        if not mine:
            raise PatchError(f"the outline has no segment on patch {name!r}")
        if any(s.centre is not None for s in mine):
            raise PatchError(f"patch {name!r} has a curved segment; bounds need straight ones")
    n = len(segments)
    piece = np.full(n, -1)
    starts = [i for i in range(n) if role[i] == "free" and role[i - 1] != "free"]
    for number, i in enumerate(starts):
        while role[i % n] == "free":
            piece[i % n] = number
            i += 1
    jump = np.zeros(len(starts))
    for i in range(n):
        if {role[i - 1], role[i]} == {"held", "driven"}:
            raise PatchError(f"patches 'mount' and {driven!r} touch at {segments[i].start}")
        if role[i] == "driven" and role[i - 1] == "free":
            jump[piece[i - 1]] += 1  # r² τ·n = -dφ/ds along the outline
        if role[i] == "free" and role[i - 1] == "driven":
            jump[piece[i]] -= 1
    axis = {int(piece[i]) for i, s in enumerate(segments) if s.on_axis}
    if len(axis) > 1:
        raise PatchError("the outline meets the axis in several pieces")
    return Boundary(
        held=np.flatnonzero([kind == "held" for kind in role]),
        driven=np.flatnonzero([kind == "driven" for kind in role]),
        piece=piece,
        pieces=len(starts),
        jump=jump,
        axis=axis.pop() if axis else -1,
    )
