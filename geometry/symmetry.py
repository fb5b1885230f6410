"""The smallest sector of a part that represents the whole under a load case."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from flexspline.geometry.part import Part

SymmetryCase = Literal["torsion", "lobes", "ellipse"]
ARBITRARY_DEG = 30.0
"""A body of revolution under even torque may be cut anywhere: long elements want a small sector,
a mesh of fair shape wants one no thinner than this."""


@dataclass(frozen=True)
class Sector:
    """A piece from angle 0 to `degrees`; `label` says which part of the whole it is.

    On the bounding planes the in-plane displacements vanish (torsion, lobes), or the normal displacement does
    (ellipse).
    """

    degrees: float
    label: str

    @property
    def copies(self) -> float:
        """How many sectors make the whole."""
        return 360.0 / self.degrees


def sector_of(part: Part, case: SymmetryCase) -> Sector:
    """Sector for ``"torsion"`` (even torque), ``"lobes"`` or the wave generator's ``"ellipse"``.

    N equal holes under even torque leave 1/(2N): every plane through the axis and a hole, or midway
    between two, is one of antisymmetry. A keyway, with the first hole in its plane, leaves half.
    The two lobes leave a quarter if N is even (holes mirrored about 90°), else half.
    """
    holes = part.bolts.count if part.bolts else 0
    if case == "torsion":
        if part.keyway is not None:
            return Sector(180.0, "1/2")
        if holes == 0:
            return Sector(ARBITRARY_DEG, "1/12")
        return Sector(180.0 / holes, f"1/{2 * holes}")
    if holes % 2 == 0:
        return Sector(90.0, "1/4")
    return Sector(180.0, "1/2")
