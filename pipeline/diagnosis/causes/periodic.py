"""What two causes periodic in the wave generator's angle share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Element, FitContext, Shape
from flexspline.pipeline.diagnosis.measurement.history import History

USUAL = (1, 2, 4)
"""Harmonics per turn: eccentricity, the two lobes, and twice their number."""
HARMONICS = ((1,), (2,), (4,), (1, 2), (2, 4), USUAL)
"""Sets of these that are tried together."""
OTHERS = ((3,), (5,), (6,))
"""Harmonics per turn that are tried one at a time: a ring of as many screws, or a seat that is not round, may
cause them."""
MOST_SPANNED = 13
"""A zero and the harmonics 1 to 6 fit any readings at this many positions, so the others are tried at more
positions only."""
KEYS = ("harmonic", "second_harmonic", "third_harmonic")


VARIES = 0.1
"""A harmonic of unit amplitude that varies by less over the positions is a constant there. Judgement."""


class PeriodicShapes:
    """A cause whose shapes are sets of harmonics."""

    exact: ClassVar[bool] = True
    passes_none: ClassVar[bool] = False
    shape_doubt: ClassVar[float] = 0.002
    """One and two deviations cover 67 and 100 % of 12 sizes."""
    vary: ClassVar[str] = "input_angle_deg"
    shows_over: ClassVar[str] = "input_angle_deg"

    others: ClassVar[bool] = False
    """Whether harmonics beside `USUAL` are tried too."""

    def shapes(self, rig: FitContext) -> list[Shape]:
        """Sets of harmonics, where the input angle was recorded."""
        return harmonic_shapes(rig, self.others)


def harmonic_shapes(rig: FitContext, others: bool = False) -> list[Shape]:
    """Sets of harmonics, where the input angle was recorded; `OTHERS` at enough positions only.

    At positions that are multiples of a harmonic's period it is the same everywhere; such a harmonic is
    left out, unless there is but one position.
    """
    angle = rig.history.input_angle_deg
    if angle is None:
        return []
    places = np.radians(np.unique(np.mod(angle, 360.0)))

    def varies(n: int) -> bool:
        return bool(np.ptp(np.cos(n * places)) + np.ptp(np.sin(n * places)) > VARIES)

    enough = len(np.unique(np.round(np.degrees(places)))) > MOST_SPANNED
    tried = HARMONICS + (OTHERS if others and enough else ())
    seen = {n for n in set().union(*tried) if len(places) == 1 or varies(n)}
    return [dict(zip(KEYS, map(float, n), strict=False)) for n in tried if seen.issuperset(n)]


def harmonic(shape: Shape, history: History) -> np.ndarray:
    """(n, 2m) cosine and sine of each of the shape's m harmonics."""
    if history.input_angle_deg is None:
        raise ValueError("a periodic cause needs the input angle")
    turn = np.radians(history.input_angle_deg)
    orders = [shape[k] for k in KEYS if k in shape]
    return np.column_stack([f(n * turn) for n in orders for f in (np.cos, np.sin)])


def largest_amplitude(elements: Sequence[Element]) -> float:
    """Zero-to-peak amplitude of the largest harmonic; elements may share harmonics."""
    total: dict[float, np.ndarray] = {}
    for e in elements:
        pairs = np.array(e.amplitudes).reshape(-1, 2)
        for order, pair in zip([e.shape[k] for k in KEYS if k in e.shape], pairs, strict=True):
            total[order] = total.get(order, np.zeros(2)) + pair
    return max(float(np.hypot(*pair)) for pair in total.values())
