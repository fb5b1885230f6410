"""K_b under the lobe load from K_b in torsion, if a part's two enclosing bodies differ too much.

The holes lie by the mount, where little arrives of a load on the rim but its torque. So what they add to 1/K
under the lobes is what they add in torsion, which the solid model knows, and at most what the two bodies of
revolution differ by in the other harmonics (proof: docs/theory.md). A rim that is held needs no
solid model of its own then; nor does a free one whose second harmonic does not reach the holes.
"""

from __future__ import annotations

from dataclasses import replace
from math import lcm, sqrt

from flexspline.fea.types import MET, Shortfall, Stiffness
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.percent import percent
from flexspline.geometry.shapes import Flexspline
from flexspline.pipeline.enclosed_part import TOO_FAR
from flexspline.pipeline.enclosure import TwoBodies

ENTRY_DOUBT, FLUSH_DOUBT = 0.001, 0.03
"""Of what the holes add in torsion: it is known for a ring that is turned, the lobes press on it. On thirteen
pairs of bodies of random parts their difference was the same both ways to 5e-5, to 0.002 on one whose meshes
still moved by as much. Where the ring begins on a hat's flange it was 0.9 to 1.4 % less under the lobes, on a
cup's diaphragm up to 0.4 % more, 0.3 mm above a flange 0.25 % less, and 0.85 mm above, a little more than the
ring's thickness, 0.03 %."""


def entry_doubt(f: Flexspline) -> float:
    """Return FLUSH_DOUBT for a ring nearer than its thickness to diaphragm or land, else ENTRY_DOUBT."""
    free = f.ring_start - max(f.hole_depth, f.diaphragm_thickness_mm)
    return ENTRY_DOUBT if free >= f.ring_thickness_mm else FLUSH_DOUBT


def lobes_by_torsion(
    K_b: Stiffness,
    torsion_whole: Stiffness,
    lobes: TwoBodies,
    holes: int,
    tolerance: float,
    entry: float = ENTRY_DOUBT,
) -> Stiffness:
    """Return K_b of the part under the lobe load; the bounds are estimates.

    Parameters
    ----------
    K_b, torsion_whole : in torsion, of the part and of its whole body.
    lobes : under the lobe load, of both bodies, with their `harmonics`.
    holes : how many are spread evenly over the turn.
    tolerance : half-width wanted; why it is missed is the `shortfall`.
    entry : `entry_doubt` of the part.

    Raises
    ------
    ComputationError : a body without `harmonics`, of a load case that is not solved by them.
    """
    if not (lobes.cut.harmonics and lobes.whole.harmonics):
        raise ComputationError("no harmonics tell the load's torque from the rest")
    low, high = _added(K_b, torsion_whole, entry)
    rest = _apart(lobes, 2)
    # N holes couple harmonic 0 with multiples of N, and the load has even ones only
    coupled = 2 * sqrt(high * _apart(lobes, lcm(2, holes)))
    whole = lobes.whole
    softest = 1 / whole.lower_Nm_per_rad + high + rest + coupled
    stiffest = 1 / whole.upper_Nm_per_rad + max(low - coupled, 0.0)
    K = 2 / (softest + stiffest)
    stiffness = replace(
        K_b.times(K / K_b.K_Nm_per_rad),
        lower_Nm_per_rad=1 / softest,
        upper_Nm_per_rad=1 / stiffest,
        guaranteed=False,
        method=(
            f"{whole.method}; the holes add to 1/K what they add in torsion, and {percent(rest * K)} at"
            " most in the load's other harmonics"
        ),
        proven_Nm_per_rad=None,
    )
    if stiffness.half_width <= tolerance:
        return replace(stiffness, shortfall=MET)
    return replace(stiffness, shortfall=K_b.shortfall or Shortfall(TOO_FAR))


def _added(K_b: Stiffness, whole: Stiffness, entry: float) -> tuple[float, float]:
    """What the holes add to 1/K in torsion, from and to [rad/(N·m)]."""
    low = 1 / K_b.upper_Nm_per_rad - 1 / whole.lower_Nm_per_rad
    high = 1 / K_b.lower_Nm_per_rad - 1 / whole.upper_Nm_per_rad
    return max(low, 0.0) * (1 - entry), max(high, 0.0) * (1 + entry)


def _apart(lobes: TwoBodies, first: int) -> float:
    """1/K of the cut body less that of the whole one, at most, over the harmonics first, 2·first, …"""
    every = first // 2

    def share(body: Stiffness) -> float:
        return sum(body.harmonics[every::every])

    cut, whole = lobes.cut, lobes.whole
    difference = share(cut) / cut.lower_Nm_per_rad - share(whole) / whole.upper_Nm_per_rad
    return max(difference, 0.0)
