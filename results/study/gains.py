"""Gains from tighter tolerances as printed; gains below the sampling error are printed as “< x”."""

from __future__ import annotations

from math import ceil

from scipy.optimize import isotonic_regression

from flexspline.pipeline.study.scatter import Scatter

STEP = 0.1
"""The last digit that is printed, in the figure's unit."""


def gains_drawn(s: Scatter) -> dict[tuple[str, float], float]:
    """As `gains_shown`; 0 where sampling hides it."""
    least = least_gain(s)
    return {one: gain if gain >= least else 0.0 for one, gain in gains_shown(s).items()}


def gains_shown(s: Scatter) -> dict[tuple[str, float], float]:
    """How much narrower the 95 % range gets, in the figure's unit, by input and factor; 0 and more.

    An input that scatters less cannot buy less: gains in the wrong order are the sampling's, and each group
    of them is shown as its mean (isotonic regression). The record has them as sampled.
    """
    shown: dict[tuple[str, float], float] = {}
    for key, gains in _by_input(s).items():
        rising = isotonic_regression([gain for _, gain in gains]).x
        shown |= {
            (key, factor): max(0.0, float(one))
            for (factor, _), one in zip(gains, rising, strict=True)
        }
    return shown


def least_gain(s: Scatter) -> float:
    """What sampling hides, in the figure's unit: the largest fall of a gain where the scatter gets less, or
    the largest gain below zero, rounded up to `STEP`; 0 where neither would be seen in print.
    """
    most = 0.0
    for gains in _by_input(s).values():
        best = 0.0
        for _, gain in gains:
            most, best = max(most, best - gain), max(best, gain)
    return STEP * ceil(most / STEP) if most >= STEP / 2 else 0.0


def gain_text(gain: float, least: float) -> str:
    """``1.2``, or ``< 0.3`` of one that sampling hides."""
    return f"< {least:.1f}" if gain < least else f"{gain:.1f}"


def _by_input(s: Scatter) -> dict[str, list[tuple[float, float]]]:
    """Factors and gains as sampled, from the widest tolerance to none, by input."""
    by_input: dict[str, list[tuple[float, float]]] = {}
    for one in sorted(s.tightened, key=lambda tightened: -tightened.factor):
        by_input.setdefault(one.key, []).append((one.factor, one.bought))
    return by_input
