"""Effects in time: creep, drift of the reading, twist that lags the torque's rate."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hidden.clearance import lagged
from hidden.effect import CannotShowError, Hidden, Setting
from hidden.fit import amounts
from hidden.program import Program

Kernel = Callable[[np.ndarray], np.ndarray]
"""Growth of twist, as a share of the elastic one, a time [s] after a unit step of torque."""
HOUR = 3600.0


def draw_creep(s: Setting, rng: np.random.Generator) -> Hidden:
    """Logarithmic, power-law or Kelvin-chain creep; steps of torque superpose."""
    if not s.program.hold:
        raise CannotShowError("creep needs holds")
    percent = s.size(0.7, 1.8, 4.5, rng)
    kernel, law = KERNELS[int(rng.integers(len(KERNELS)))](s.program, rng)
    scale = percent / per_decade(kernel, s.program.hold)
    percent = scale * per_decade(kernel, s.program.typical_hold)  # docs/contract.md
    taus = np.geomspace(s.program.quickest / 1000, s.program.time[-1] * 3, 22)
    weights = kelvin_chain(kernel, taus, s.program.time[-1])

    def angle(p: Program, gear: object) -> np.ndarray:
        grown = sum(
            w * lagged(p.torque, p.time, tau) for w, tau in zip(weights, taus, strict=True) if w
        )
        return scale * s.gear.compliance * np.asarray(grown)

    return Hidden("creep", percent, f"creep {law}, {percent:.2f} %/decade", angle)


def per_decade(kernel: Kernel, hold: float) -> float:
    """Growth in % of the elastic twist over the last decade of a hold of that length [s]."""
    grown = kernel(np.array([hold / 10, hold]))
    return float(100 * (grown[1] - grown[0]))


def kelvin_chain(kernel: Kernel, taus: np.ndarray, longest: float) -> np.ndarray:
    """Weights of Kelvin elements 1 − exp(−t/τ) that follow the kernel up to the longest time [s]."""
    t = np.geomspace(taus[0] / 2, longest, 160)
    return amounts(1 - np.exp(-t[:, None] / taus), kernel(t))


def logarithmic(p: Program, rng: np.random.Generator) -> tuple[Kernel, str]:
    t0 = p.hold * np.exp(rng.uniform(np.log(0.004), np.log(0.05)))
    return lambda t: np.log10(1 + t / t0), f"log10(1 + t/{t0:.2g} s)"


def power_law(p: Program, rng: np.random.Generator) -> tuple[Kernel, str]:
    t0, n = p.hold * rng.uniform(0.005, 0.05), rng.uniform(0.08, 0.3)
    return lambda t: (1 + t / t0) ** n - 1, f"(1 + t/{t0:.2g} s)^{n:.2f} − 1"


def chain(p: Program, rng: np.random.Generator) -> tuple[Kernel, str]:
    n = int(rng.integers(4, 7))
    tau = p.hold * np.geomspace(0.02, 8, n) * np.exp(rng.uniform(-0.3, 0.3, n))
    weight = rng.uniform(0.6, 1.4, n)
    return (lambda t: (1 - np.exp(-t[:, None] / tau)) @ weight), f"Kelvin chain of {n}"


KERNELS = (logarithmic, power_law, chain)


def draw_drift(s: Setting, rng: np.random.Generator) -> Hidden:
    """The reading wanders off: straight, saturating or slightly curved."""
    total = s.windup * s.size(0.04, 0.1, 0.25, rng) * rng.choice([-1, 1])
    end = s.program.time[-1]
    kind = str(rng.choice(["linear", "saturating", "curved"]))
    bend, settle = rng.uniform(-0.3, 0.3), rng.uniform(0.3, 1.2)

    def shape(time: np.ndarray) -> np.ndarray:
        u = time / end
        if kind == "linear":
            return u
        return u + bend * u * (1 - u) if kind == "curved" else 1 - np.exp(-u / settle)

    scale = total / float(shape(np.array(end)))
    return Hidden(
        "sensor_drift",
        per_hour(*(x[s.program.rows] for x in (scale * shape(s.program.time), s.program.time))),
        f"drift {kind}, {total:+.2f}″ in {end / HOUR:.3f} h",
        lambda p, g: scale * shape(p.time),
    )


def per_hour(drift: np.ndarray, time: np.ndarray) -> float:
    """(last − first) / hours."""
    return float((drift[-1] - drift[0]) / (time[-1] - time[0]) * HOUR)


def draw_rate(s: Setting, rng: np.random.Generator) -> Hidden:
    """A first-order lag, a viscous shift, or one slightly curved in the rate."""
    shift = s.windup * s.size(0.03, 0.08, 0.2, rng)
    top = float(np.quantile(np.abs(s.program.rate), 0.98))
    kind = str(rng.choice(["lag", "viscous", "curved"]))
    if kind == "lag":
        lag = min(shift / (s.gear.compliance * top), 0.06 * s.program.quickest)
        return Hidden(
            "rate_dependence",
            s.gear.compliance * lag,
            f"twist lags by {lag:.3f} s",
            lambda p, g: s.gear.compliance * (lagged(p.torque, p.time, lag) - p.torque),
        )
    power = 1.0 if kind == "viscous" else rng.uniform(0.85, 1.15)
    settle = 0.004 * s.program.quickest  # a film builds up; no jump of angle at a corner of torque

    def angle(p: Program, gear: object) -> np.ndarray:
        rate = lagged(p.rate, p.time, settle) / top
        return -shift * np.sign(rate) * np.abs(rate) ** power

    rates = np.abs(s.program.rate[s.program.rows])
    return Hidden(
        "rate_dependence",
        shift_per_rate(rates, shift * (rates / top) ** power),
        f"shift {shift:.2f}″ at {top:.3g} N·m/s, power {power:.2f}",
        angle,
    )


def shift_per_rate(rate: np.ndarray, shift: np.ndarray) -> float:
    """One branch's shift per torque rate over the record's own rates, by least squares from 0."""
    return float(rate @ shift / (rate @ rate))
