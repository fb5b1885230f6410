"""One measurement as a file, with what truly went into it kept beside it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hidden.effect import Hidden
from hidden.gear import Gear, Rig
from hidden.noise import Noise, Spread, read_by_encoder, sample, spread
from hidden.program import Program


@dataclass(frozen=True)
class Unit:
    """One unit's measurement; arrays run over its samples.

    Attributes
    ----------
    effects : arcsec, one array per hidden effect, as seen by who trusts the torque reading.
    angle : read, arcsec. torque : read, N·m. outlier : bool.
    """

    program: Program
    gear: Gear
    spread: Spread
    effects: tuple[np.ndarray, ...]
    angle: np.ndarray
    torque: np.ndarray
    outlier: np.ndarray
    noise: Noise

    @property
    def true_torque(self) -> np.ndarray:
        return self.program.torque[self.program.rows]


def sign(torque: np.ndarray, width: float) -> np.ndarray:
    """Which side of the gap: at once, or over a width [N·m]."""
    return np.tanh(torque / width) if width else np.sign(torque)


def measure(
    rig: Rig,
    gear: Gear,
    program: Program,
    hidden: tuple[Hidden, ...],
    noise: Noise,
    rng: np.random.Generator,
) -> Unit:
    """Simulate the unit on the grid, read it at the samples."""
    rows, torque = program.rows, program.torque
    ahead = next((h.teeth for h in hidden if h.teeth), None)
    teeth = replace(program, torque=ahead(program, gear)) if ahead else program
    effects = [h.angle(program if h.teeth else teeth, gear)[rows] for h in hidden]
    offset = sum(h.reading_Nm for h in hidden)
    width = 0.0 if any(h.crosses for h in hidden) else noise.crossing
    gap = gear.gap * sign(torque, width)[rows] / 2
    true = gear.zero + gear.compliance * torque[rows] + gap + sum(effects)
    shaking, outlier, on_torque = sample(noise, program, rng)
    for k, h in enumerate(hidden):
        if h.reading_Nm:  # what the reader of a shifted torque finds missing
            t = torque[rows]
            line = gear.compliance * t + gear.gap * np.sign(t) / 2
            shifted = t + h.reading_Nm
            effects[k] = line - gear.compliance * shifted - gear.gap * np.sign(shifted) / 2
    return Unit(
        program,
        gear,
        spread(noise, program, gear.compliance, gear.gap),
        tuple(effects),
        read_by_encoder(true + shaking, noise.step),
        torque[rows] + on_torque + offset,
        outlier,
        noise,
    )


def as_csv(units: list[Unit], rng: np.random.Generator) -> str:
    """The file a logger writes: columns of docs/contract.md, digits of a real instrument."""
    several = len(units) > 1
    columns = units[0].program.columns
    header = [*(["unit"] if several else []), *columns, "torque_Nm", "angle_arcsec"]
    first_cycle, clock = (
        int(rng.integers(2)),
        float(rng.choice([0.0, rng.uniform(0, 1e5)], p=[0.7, 0.3])),
    )
    order = rng.permutation(len(header)) if rng.random() < 0.2 else np.arange(len(header))
    lines = ["# test rig 3, wave generator locked"] if rng.random() < 0.2 else []
    name = _names(rng)
    lines.append(",".join(name.get(header[k], header[k]) for k in order))
    for number, unit in enumerate(units, 1):
        p, rows = unit.program, unit.program.rows
        air = p.temperature[rows] + rng.normal(size=len(rows)) * 0.03
        text = {
            "unit": [str(number)] * len(rows),
            "time_s": [
                _digits((x + clock) * FACTOR.get(name.get("time_s", ""), 1)) for x in p.time[rows]
            ],
            "cycle": [str(x - 1 + first_cycle) for x in p.cycle[rows]],
            "temperature_C": [f"{x:.2f}" for x in air],
            "input_angle_deg": [f"{x:.1f}" for x in p.position[rows]],
            "torque_Nm": [
                _digits(x * FACTOR.get(name.get("torque_Nm", ""), 1)) for x in unit.torque
            ],
            "angle_arcsec": [
                _digits(x * FACTOR.get(name.get("angle_arcsec", ""), 1)) for x in unit.angle
            ],
        }
        lines += [",".join(row) for row in zip(*(text[header[k]] for k in order), strict=True)]
    return "\n".join(lines) + "\n"


FACTOR = {
    "torque_Nmm": 1e3,
    "angle_arcmin": 1 / 60,
    "angle_deg": 1 / 3600,
    "angle_mrad": np.pi / 648,
    "time_min": 1 / 60,
    "time_h": 1 / 3600,
}
"""Other units that a file may use, per N·m, arcsec and s."""


def _names(rng: np.random.Generator) -> dict[str, str]:
    """In one file of six, other units in the header."""
    if rng.random() > 1 / 6:
        return {}
    angle = str(rng.choice(["angle_arcmin", "angle_deg", "angle_mrad"]))
    return {
        "torque_Nm": str(rng.choice(["torque_Nm", "torque_Nmm"])),
        "angle_arcsec": angle,
        "time_s": str(rng.choice(["time_s", "time_min", "time_h"])),
    }


def _digits(x: float) -> str:
    """Ten digits: more than the encoder and the clock have."""
    return f"{x:.10g}"
