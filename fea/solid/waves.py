"""Cyclic waves of a part with n equal repeats: a turn by one repeat multiplies a wave by a phase.

f = Σ f_p over p = 0 … n − 1 with f_p(φ) = 1/n Σ_j exp(−2πi p j/n) f(φ + 2π j/n), so that f_p(φ + 2π/n) =
exp(2πi p/n) f_p(φ). Of a real f the waves p and n − p are conjugate: half of them say all
(docs/theory.md, "Waves on half a repeat").
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import pi

import numpy as np


@dataclass(frozen=True)
class CyclicWave:
    """Number p of the waves of a part with n repeats, 0 ≤ p ≤ n/2; with it, where it is another, n − p."""

    number: int
    repeats: int

    @property
    def is_real(self) -> bool:
        """Whether wave and conjugate are one: p = 0 and p = n/2."""
        return 2 * self.number % self.repeats == 0

    @property
    def times(self) -> int:
        """How many waves it stands for."""
        return 1 if self.is_real else 2

    @property
    def phase(self) -> float:
        """Phase of half a repeat [rad]."""
        return pi * self.number / self.repeats

    def of(self, function: Callable[[np.ndarray], np.ndarray], phi: np.ndarray) -> np.ndarray:
        """Return f_p at angles [rad] of a function with the period 2π; complex, real where p is."""
        total = np.zeros(phi.shape, complex)
        for j in range(self.repeats):
            turn = 2 * pi * j / self.repeats
            total += np.exp(-1j * self.number * turn) * function(phi + turn)
        return (total.real if self.is_real else total) / self.repeats

    def on_copy(self, values: np.ndarray, copy: int) -> np.ndarray:
        """Return the wave and its conjugate on a copy of half a repeat, before it is put in place.

        Copies are counted from angle 0, and those of odd number are reflections (`solid.unfold`): the field
        is even or odd at angle 0, so a reflection makes of it its conjugate.
        """
        reflected = copy % 2
        turned = np.exp(1j * self.phase * (copy + reflected))
        return self.times * (values * (turned.conjugate() if reflected else turned)).real


def waves(orders: Iterable[int], repeats: int) -> tuple[CyclicWave, ...]:
    """Return the waves that hold circumferential orders ±k, from p = 0 up."""
    numbers = {min(k % repeats, -k % repeats) for k in orders}
    return tuple(CyclicWave(p, repeats) for p in sorted(numbers))
