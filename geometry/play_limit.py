"""The largest play of the wave generator's bearing for which the involute model is valid."""

from __future__ import annotations

from math import cos

ROUNDING_SHARE = 1e-12
"""A length this share beyond its limit is at the limit: the two were computed, or written, in another way."""


def play_limit(centre_distance: float, pressure_angle: float) -> float:
    """Largest play that the involute model answers, c_max = 2a(1 − cos α), in the unit of a.

    Parameters: a = m(z2 − z1)/2, α [rad]. At c_max the working pressure angle is 0.

    Examples
    --------
    Module 0.2, 200 and 202 teeth, 20°:

    >>> from math import radians
    >>> round(play_limit(0.2, radians(20)) * 1e3, 2)
    24.12
    """
    return 2 * centre_distance * (1 - cos(pressure_angle))


def beyond_play_limit(play: float, limit: float) -> bool:
    """Whether a play c is beyond c_max, both in one unit."""
    return play > limit * (1 + ROUNDING_SHARE)
