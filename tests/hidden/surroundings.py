"""Temperature of the air and positions of the wave generator while the torque goes round."""

from __future__ import annotations

import numpy as np

REFERENCE_C = 20.0


def temperature(
    air: str,
    time: np.ndarray,
    progress: np.ndarray,
    cycles: int,
    rng: np.random.Generator,
    extra: dict[str, float],
) -> np.ndarray:
    """°C at every time [s]; `air` as in `Plan.air`, `extra["constant_C"]` fixes the constant one."""
    span = rng.uniform(6, 25) * rng.choice([-1, 1], p=[0.2, 0.8])
    first = REFERENCE_C + rng.uniform(-2, 6)
    share = np.maximum(time, 0) / time[-1]
    if air == "none":
        return np.full_like(time, REFERENCE_C)
    if air == "constant":
        return np.full_like(time, extra.get("constant_C", REFERENCE_C + rng.uniform(-0.5, 0.5)))
    if air == "ramp":
        return first + span * share
    if air == "rise":  # in step with the cycles, as where nobody waited for the gear to cool
        return first + abs(span) * progress / cycles
    if air == "heating":
        return first + abs(span) * (1 - np.exp(-share / rng.uniform(0.15, 0.5)))
    if air == "swing":
        turns = rng.uniform(0.7, 2.5)
        return first + span / 2 * np.sin(2 * np.pi * (turns * share + rng.random()))
    levels = np.linspace(0, 1, max(2, min(cycles, int(rng.integers(2, 5)))))
    if air == "oven":  # up in steps, or up and down
        per_cycle = np.sort(np.resize(levels, cycles))
        if rng.random() < 0.5:
            per_cycle = np.concatenate([per_cycle[::2], per_cycle[1::2][::-1]])
    else:  # shuffled
        per_cycle = rng.permutation(np.resize(levels, cycles))
    return (
        _settling(per_cycle[np.minimum(progress.astype(int), cycles - 1)], share, cycles) * span
        + first
    )


def _settling(target: np.ndarray, share: np.ndarray, cycles: int) -> np.ndarray:
    """The oven follows its set point within a tenth of a cycle."""
    keep = np.exp(-np.diff(share) * cycles * 10)
    out = np.empty_like(target)
    out[0] = target[0]
    for k, hold in enumerate(keep):
        out[k + 1] = target[k + 1] + (out[k] - target[k + 1]) * hold
    return out


def input_positions(place: str, cycles: int, rng: np.random.Generator) -> np.ndarray:
    """Wave-generator angle [deg] of every cycle; `place` as in `Plan.places`."""
    if place == "none":
        return np.zeros(cycles)
    if place == "constant":
        return np.full(cycles, round(float(rng.uniform(0, 360)), 1))
    if place == "even":
        return (np.arange(cycles) * 360 / cycles + rng.uniform(0, 40)).round(1) % 360
    if place == "random":
        return rng.uniform(0, 360, cycles).round(1)
    few = rng.uniform(0, 360, int(rng.integers(2, max(3, cycles // 2 + 1)))).round(1)
    return np.resize(few, cycles)
