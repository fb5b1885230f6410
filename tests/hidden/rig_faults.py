"""What a rig may do that no gear does: a lock that slips, ringing, stick-slip; and a ripple of the teeth.

At unit size, like `foreign`; drawn only where asked for by name, so that old seeds keep their records.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hidden.effect import CannotShowError, Setting
from hidden.foreign import Shape
from hidden.program import Program


def lock_slips(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    """A greased clamp: beyond its capacity it creeps on at a rate in proportion to what it cannot hold.

    Its capacity differs a little each time it is passed; nothing brings it back but torque the other way.
    """
    holds = rng.uniform(0.5, 0.85)
    seed = int(rng.integers(2**31))

    def shape(p: Program) -> np.ndarray:
        capacity = _each_load(p, holds, seed)
        beyond = np.sign(p.load) * np.maximum(np.abs(p.load) - capacity, 0.0)
        way = np.concatenate([[0.0], np.cumsum((beyond[1:] + beyond[:-1]) / 2 * np.diff(p.time))])
        return _unit(way)

    return shape, f"the lock slips beyond {holds:.2f} of the torque, a little more each second"


def lock_yields(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    """A clamp of several screws: beyond its capacity it follows at once, and stays where it is."""
    holds = rng.uniform(0.5, 0.85)
    seed = int(rng.integers(2**31))

    def shape(p: Program) -> np.ndarray:
        capacity, out, at = _each_load(p, holds, seed), np.empty(len(p.load)), 0.0
        for k, q in enumerate(p.load):
            at = min(max(at, q - capacity[k]), q + capacity[k])
            out[k] = at
        return _unit(out)

    return shape, f"the lock yields beyond {holds:.2f} of the torque and stays"


def _each_load(p: Program, holds: float, seed: int) -> np.ndarray:
    """Capacity (n,) of a clamp at each load: within 8 % of `holds`, another each time torque passes zero."""
    load = np.concatenate([[0], np.cumsum(np.diff(np.sign(p.load)) != 0)])
    each = np.random.default_rng(seed).normal(size=int(load[-1]) + 1)
    return holds * (1 + 0.08 * np.clip(each, -2, 2))[load]


def ringing(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    """The rig's inertia on the gear's spring: each sudden change of the torque's rate rings and dies away."""
    spacing = float(np.median(np.diff(s.program.time[s.program.rows])))
    corners, change = _corners(s.program)
    apart = float(np.median(np.diff(corners)))
    if len(corners) < 6 or apart < 24 * spacing:
        raise CannotShowError("too few rows between two corners of the torque")
    period = float(np.exp(rng.uniform(np.log(4 * spacing), np.log(apart / 4))))
    damping = rng.uniform(0.03, 0.15)

    def shape(p: Program) -> np.ndarray:
        out = np.zeros(len(p.time))
        omega = 2 * np.pi / period
        for at, by in zip(corners, change, strict=True):
            t = np.maximum(p.time - at, 0.0)
            out += by * np.exp(-damping * omega * t) * np.sin(omega * np.sqrt(1 - damping**2) * t)
        return _unit(out)

    return shape, f"ringing of {period:.2f} s after each corner, damping {damping:.2f}"


def _corners(p: Program) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] where the torque's rate changes suddenly, and by how much, relative to the largest change."""
    step = np.diff(np.diff(p.torque) / np.diff(p.time))
    largest = np.abs(step).max()
    at = np.flatnonzero(np.abs(step) > 0.3 * largest)
    return p.time[1:-1][at], step[at] / largest


def stick_slip(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    """A dry seal: the output sticks while torque goes on, breaks away at random, and sticks again."""
    reach = rng.uniform(0.03, 0.12)
    seed = int(rng.integers(2**31))

    def shape(p: Program) -> np.ndarray:
        draw = np.random.default_rng(seed)
        out, behind, before, limit = np.empty(len(p.load)), 0.0, 0.0, reach
        for k, q in enumerate(p.load):
            behind -= q - before
            before = q
            while abs(behind) > limit:
                behind = np.sign(behind) * limit * draw.uniform(0.0, 0.4)
                limit = reach * np.exp(0.4 * draw.normal())
            out[k] = behind
        return out / reach

    return shape, f"stick-slip, breaking away after about {reach:.3f} of the torque"


def tooth_ripple(s: Setting, rng: np.random.Generator) -> tuple[Shape, str]:
    """Position error at the teeth's own frequencies: z per turn and 2z, beside each other."""
    z = int(rng.integers(80, 161))
    part, phase = rng.uniform(0, 0.6), rng.uniform(0, 6.28, 2)

    def shape(p: Program) -> np.ndarray:
        turn = np.radians(p.position)
        return np.sin(2 * z * turn + phase[0]) + part * np.sin(z * turn + phase[1])

    return shape, f"a ripple of {2 * z} per turn, {part:.2f} of it of {z}"


def _unit(way: np.ndarray) -> np.ndarray:
    """Range 2, as of a wave of amplitude 1."""
    if np.ptp(way) < 1e-9:
        raise CannotShowError("nothing moves")
    return 2 * way / np.ptp(way)


RIG_FAULTS: dict[str, Callable[[Setting, np.random.Generator], tuple[Shape, str]]] = {
    "lock_slips": lock_slips,
    "lock_yields": lock_yields,
    "ringing": ringing,
    "stick_slip": stick_slip,
    "tooth_ripple": tooth_ripple,
}
