"""Effects in the gap: its size, its temperature, its wear."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hidden.effect import CannotShowError, Hidden, Setting
from hidden.program import Program
from hidden.surroundings import REFERENCE_C


def side(program: Program) -> np.ndarray:
    """Half the sign of the torque: the share of a change of gap that shows."""
    return np.sign(program.torque) / 2


def draw_offset(s: Setting, rng: np.random.Generator) -> Hidden:
    """A gap 7 to 20 standard deviations off; where it can, in one case of three smaller."""
    change = s.rig.gap_std * s.size(7.5, 11, 17, rng)
    if rng.random() < 0.35 and change < s.gear.gap:
        change = -change
    return Hidden(
        "clearance_offset",
        s.gear.gap + change - s.rig.gap,
        f"gap {change:+.1f}″ on a gear drawn {s.gear.gap - s.rig.gap:+.1f}″ off",
        lambda p, g: change * side(p),
    )


def draw_thermal(s: Setting, rng: np.random.Generator) -> Hidden:
    """The gap follows the temperature at once or with a lag of up to a third of a cycle."""
    reach = float(np.abs(s.program.temperature - REFERENCE_C).max())
    if reach < 2:
        raise CannotShowError("no temperature to speak of")
    per_kelvin = s.windup * s.size(0.05, 0.12, 0.3, rng) / reach
    if rng.random() < 0.4:
        per_kelvin = -min(per_kelvin, 0.9 * s.gear.gap / reach)
    lag = float(rng.choice([0.0, 0.1, 0.3])) * rng.uniform(0.5, 1) * s.program.quickest
    return Hidden(
        "thermal_clearance",
        per_kelvin,
        f"gap {per_kelvin:+.3f}″/K, lag {lag:.1f} s",
        lambda p, g: per_kelvin * (lagged(p.temperature, p.time, lag) - REFERENCE_C) * side(p),
    )


def lagged(x: np.ndarray, time: np.ndarray, lag: float) -> np.ndarray:
    """First-order lag [s] of x, straight between the times: exact for that."""
    if lag == 0:
        return x
    h = np.diff(time) / lag
    keep = np.exp(-h)
    mean = (1 - keep) / h
    more = x[:-1] * (mean - keep) + x[1:] * (1 - mean)
    out = [float(x[0])]
    for kept, added in zip(keep.tolist(), more.tolist(), strict=True):
        out.append(out[-1] * kept + added)
    return np.array(out)


def draw_wear(s: Setting, rng: np.random.Generator) -> Hidden:
    """Growth in a straight line, run-in that saturates, a square root; smooth or cycle by cycle."""
    n = float(np.ceil(s.program.progress[-1] - 1e-9))
    total = s.windup * s.size(0.05, 0.12, 0.3, rng)
    run_in = rng.uniform(0.5, 1.5) * n
    kind = str(rng.choice(["linear", "run-in", "square root"]))
    growth: Callable[[np.ndarray], np.ndarray] = {
        "linear": lambda c: c,
        "run-in": lambda c: 1 - np.exp(-c / run_in),
        "square root": np.sqrt,
    }[kind]
    by_cycle = rng.random() < 0.3
    clock = (lambda p: p.cycle - 1.0) if by_cycle else (lambda p: p.progress)
    scale = total / float(growth(np.array(clock(s.program)[-1])))

    def gap(p: Program) -> np.ndarray:
        return scale * growth(clock(p))

    return Hidden(
        "wear",
        per_cycle(gap(s.program), clock(s.program)),
        f"wear {kind}{' by cycle' if by_cycle else ''}, {total:.1f}″ in {n:.0f} cycles",
        lambda p, g: gap(p) * side(p),
    )


def per_cycle(gap: np.ndarray, cycles: np.ndarray) -> float:
    """(last − first) / cycles between them, arcsec/cycle."""
    return float((gap[-1] - gap[0]) / (cycles[-1] - cycles[0]))
