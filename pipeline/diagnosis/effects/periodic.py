"""What two causes periodic in the wave generator's angle share."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pipeline.diagnosis.effects.cause import Element, Rig, Shape
from pipeline.diagnosis.record import History

HARMONICS = (1, 2, 3, 4, 6)
"""Per turn: eccentricity, the two lobes, and their multiples."""


def harmonic_shapes(rig: Rig) -> list[Shape]:
    """One shape per harmonic, where the input angle was recorded."""
    return [] if rig.history.input_angle_deg is None else [{"harmonic": n} for n in HARMONICS]


def harmonic(shape: Shape, history: History) -> np.ndarray:
    """(n, 2) cosine and sine of the harmonic."""
    if history.input_angle_deg is None:
        raise ValueError("a periodic cause needs the input angle")
    turn = shape["harmonic"] * np.radians(history.input_angle_deg)
    return np.column_stack([np.cos(turn), np.sin(turn)])


def largest_amplitude(elements: Sequence[Element]) -> float:
    """Zero-to-peak amplitude of the largest harmonic."""
    return max(float(np.hypot(*e.amplitudes)) for e in elements)
