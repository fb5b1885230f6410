"""Effects that are in no vocabulary, at unit size; `cases` scales them to stand out of the noise."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hidden.effect import CannotShowError, Hidden, Setting
from hidden.gear import Gear
from hidden.program import Program

Shape = Callable[[Program], np.ndarray]
"""Arcsec on the grid for a size of about one wind-up (times a share that `cases` chooses)."""


def softening(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    power = rng.uniform(2, 4)
    return lambda p: np.sign(p.torque) * np.abs(p.load) ** power, f"softening, power {power:.1f}"


def torque_ripple(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    periods, phase = rng.uniform(2, 6), rng.uniform(0, 6.28)
    return (
        lambda p: np.sin(2 * np.pi * periods * p.load + phase),
        f"ripple in torque, {periods:.1f} periods up to the peak",
    )


def encoder_eccentricity(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    """Periodic in the output angle, of a grating of many lines over the small turn here."""
    periods, phase = rng.uniform(2, 6), rng.uniform(0, 6.28)
    reach = s.windup + s.gear.gap / 2

    def shape(p: Program) -> np.ndarray:
        angle = s.gear.compliance * p.torque + s.gear.gap / 2 * np.sign(p.torque)
        return np.sin(2 * np.pi * periods * angle / reach + phase)

    return shape, f"ripple in output angle, period {reach / periods:.1f}″"


def slow_wave(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    turns, phase = rng.uniform(1.3, 3.5), rng.uniform(0, 6.28)
    return lambda p: np.sin(
        2 * np.pi * turns * p.time / p.time[-1] + phase
    ), f"slow wave, {turns:.1f} turns"


def zero_step(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    when = rng.uniform(0.25, 0.75)
    return lambda p: 1.0 * (p.time > when * p.time[-1]), f"zero steps at {when:.2f} of the time"


def zero_with_temperature(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    return lambda p: _centred(p.temperature), "zero moves with temperature"


def stiffness_with_temperature(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    return lambda p: p.load * _centred(p.temperature), "stiffness moves with temperature"


def stiffness_with_cycle(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    power = rng.choice([0.5, 1.0])
    return (
        lambda p: p.load * (p.progress / p.progress[-1]) ** power,
        f"compliance grows as cycles^{power}",
    )


def zero_each_cycle(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    zero = rng.normal(size=int(s.program.cycle[-1]) + 1)
    return lambda p: zero[p.cycle], "a zero of its own in each cycle"


def position_step(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    """A jump at one tooth in a position scanned many times over."""
    edge = rng.uniform(60, 300)
    return lambda p: 1.0 * (p.position > edge), f"position error jumps at {edge:.0f}°"


def hum(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    """A building's machine at a period of a dozen samples or more."""
    spacing = float(np.median(np.diff(s.program.time[s.program.rows])))
    period = max(spacing * rng.uniform(8, 30), s.program.quickest / 60)
    return lambda p: np.sin(2 * np.pi * p.time / period), f"hum of {period:.2f} s"


def leading_output(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    length = rng.uniform(0.03, 0.2)

    def shape(p: Program) -> np.ndarray:
        from hidden.friction import slipping

        return slipping(p.load, np.array([length]))[:, 0] / length

    return shape, f"output leads: reversed loop, {length:.2f}"


def even_quadratic(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    return lambda p: p.load**2, "even quadratic in torque"


KINDS: dict[str, Callable[[Setting, np.random.Generator], tuple[Shape, str]]] = {
    "softening": softening,
    "torque_ripple": torque_ripple,
    "encoder_eccentricity": encoder_eccentricity,
    "slow_wave": slow_wave,
    "zero_step": zero_step,
    "zero_with_temperature": zero_with_temperature,
    "stiffness_with_temperature": stiffness_with_temperature,
    "stiffness_with_cycle": stiffness_with_cycle,
    "zero_each_cycle": zero_each_cycle,
    "position_step": position_step,
    "hum": hum,
    "leading_output": leading_output,
    "even_quadratic": even_quadratic,
}
UNIT_GAIN = "unit_gain"
"""One unit's own gain needs several units: `cases` gives it to one of them."""


def unit_gain(rng: np.random.Generator) -> tuple[Shape, str]:
    return lambda p: p.load, "one unit's own gain"


def foreign(kind: str, shape: Shape, said: str, size: float) -> Hidden:
    """The shape at a size [arcsec]."""

    def angle(program: Program, gear: Gear) -> np.ndarray:
        return size * shape(program)

    return Hidden(f"foreign:{kind}", float("nan"), f"{said}, {size:.2f}″", angle)


def _centred(x: np.ndarray) -> np.ndarray:
    span = np.ptp(x)
    if span < 2:
        raise CannotShowError("no change of temperature to speak of")
    return (x - x[0]) / span
