"""The flank clearance that play of the wave generator's bearing opens: two models, one limit.

Scalars in, scalars out; lengths in mm, angles in rad. The source's printed sign and base widths do
not hold; `docs/theory.md` lists what replaces them, the tests recompute it.
"""

from __future__ import annotations

from math import acos, cos, sin, tan

from flexspline.geometry.errors import FlexsplineError
from flexspline.geometry.play_limit import beyond_play_limit, play_limit


class BearingPlayDomainError(FlexsplineError, ValueError):
    """The bearing's play is beyond the end of the involute model.

    Attributes
    ----------
    play_um : c [µm].
    limit_um : c_max = 2a(1 − cos α) [µm].
    """

    def __init__(self, play_um: float, limit_um: float) -> None:
        self.play_um, self.limit_um = play_um, limit_um
        super().__init__(
            f"bearing play c = {play_um:.6g} µm is beyond c_max = 2a(1 - cos α) = "
            f"{limit_um:.4g} µm, where the involute model ends"
        )


def involute(angle: float) -> float:
    """Involute function, inv x = tan x − x [rad].

    Examples
    --------
    Tabulated in every gear handbook, inv 20° = 0.014904:

    >>> from math import radians
    >>> round(involute(radians(20)), 6)
    0.014904
    """
    return tan(angle) - angle


def working_pressure_angle(play: float, centre_distance: float, pressure_angle: float) -> float:
    """Working pressure angle α′ = arccos(2a cos α / (2a − c)) [rad].

    Parameters: c [mm], a [mm], α [rad]. It falls with c, from α at c = 0 to 0 at c_max; a negative
    c is preload. Source: article, section 2.1.

    Raises
    ------
    BearingPlayDomainError : c > c_max.

    Examples
    --------
    cos α′ = 0.4·0.939693/(0.4 − 0.012) = 0.968755:

    >>> from math import radians
    >>> round(cos(working_pressure_angle(0.012, 0.2, radians(20))), 6)
    0.968755
    """
    limit = play_limit(centre_distance, pressure_angle)
    if beyond_play_limit(play, limit):
        raise BearingPlayDomainError(play * 1e3, limit * 1e3)
    if play == 0:
        return pressure_angle  # arccos of its cosine is off in the last digit: no play would open a gap
    ratio = 2 * centre_distance * cos(pressure_angle) / (2 * centre_distance - play)
    return acos(min(1.0, ratio))


def involute_clearance(play: float, centre_distance: float, pressure_angle: float) -> float:
    """Normal clearance j′ = 2a cos α (inv α − inv α′) that play opens [mm].

    Parameters: c [mm], a = m(z2 − z1)/2 [mm], α [rad]. Positive for 0 < c ≤ c_max: the article
    prints the bracket the other way round, but its table 4 was made with this sign.

    Raises
    ------
    BearingPlayDomainError : c > c_max.

    Examples
    --------
    Article, table 4, c = 10 µm (which prints the circumferential j′/cos α, "~3.2"):

    >>> from math import radians
    >>> round(involute_clearance(0.010, 0.2, radians(20)) * 1e3, 2)
    3.06
    """
    working = working_pressure_angle(play, centre_distance, pressure_angle)
    opened = involute(pressure_angle) - involute(working)
    return 2 * centre_distance * cos(pressure_angle) * opened


def involute_clearance_slope(play: float, centre_distance: float, pressure_angle: float) -> float:
    """Slope dj′/dc = sin α′ of the involute model [mm/mm].

    From cos α′ = 2a cos α/(2a − c): dα′/dc = −cos α′/((2a − c) sin α′), and d inv α′ = tan² α′ dα′.
    At c = 0 it is sin α, the small-displacement model; at c_max it is 0.

    Raises
    ------
    BearingPlayDomainError : c > c_max.

    Examples
    --------
    At c = 12 µm, √(1 − 0.968755²):

    >>> from math import radians
    >>> round(involute_clearance_slope(0.012, 0.2, radians(20)), 4)
    0.248
    """
    return sin(working_pressure_angle(play, centre_distance, pressure_angle))


def small_displacement_clearance(play: float, pressure_angle: float) -> float:
    """Normal clearance j′ = c sin α: the flanks simply moved apart by Δa = c/2 [mm].

    Parameters: c [mm], α [rad]. Linear, without a limit; larger than the involute model's.

    Examples
    --------
    >>> from math import radians
    >>> round(small_displacement_clearance(0.010, radians(20)) * 1e3, 2)
    3.42
    """
    return play * sin(pressure_angle)
