"""Writes xb1-40-sweep.csv: a made-up torque sweep, so that `flexspline diagnose` has something to read.

Nobody measured this. The gear is examples/xb1-40.toml with a stiffness and a gap drawn inside its
stated uncertainty; added to it are
- friction: 40 sliders in parallel springs whose loads follow a triangle distribution, loop 4.6 arcsec
  wide at zero torque; and
- a gap that shrinks by 0.42 arcsec for each kelvin above 20 °C, as the flexspline warms up.
Six cycles at six temperatures in mixed order, an encoder step of 0.1 arcsec, noise of 0.35 arcsec that
remembers the row before, torque noise of 2 mN·m, two glitches of the encoder.
It knows nothing of the program that will read it.

    python3 examples/measured/make_sweep.py > examples/measured/xb1-40-sweep.csv
"""

from __future__ import annotations

import sys

import numpy as np

ARCSEC = 180 * 3600 / np.pi
STIFFNESS = 1.795e4  # N·m/rad, 1.3 % below the design's 18 184
GAP = 69.5  # arcsec at 20 °C; the design's is 72.2 ± 12.9
FRICTION = 4.6  # arcsec, full width of the loop at T = 0
PER_KELVIN = -0.42  # arcsec/K
LARGEST = 2.0  # N·m
ROWS = 96  # of a cycle
SECONDS = 240.0  # of a cycle
TEMPERATURES = (20.4, 33.8, 24.9, 38.2, 29.6, 21.7)
PAUSE = 2400.0  # s, to soak at the next temperature
ZERO = 118.3  # arcsec, where the encoder happens to stand
SEED = 40


def sliders(torque: np.ndarray, count: int = 40) -> np.ndarray:
    """Shift of the angle, ±1: sliders that each stick until pulled by their own load."""
    loads = 0.35 * LARGEST * np.sqrt((np.arange(count) + 0.5) / count)
    pulled, out, last = np.zeros(count), [], 0.0
    for now in torque:
        pulled = np.clip(pulled + (now - last), -loads, loads)
        out.append(-(pulled / loads).mean())
        last = now
    return np.array(out)


def lines(rng: np.random.Generator) -> list[str]:
    """The file's rows."""
    phase = (np.arange(ROWS) + 0.5) / ROWS
    cycle = LARGEST * (1 - 4 * np.abs((phase + 0.25) % 1 - 0.5))  # 0 → + → − → 0
    torque = np.tile(cycle, len(TEMPERATURES))
    n = len(torque)
    number = np.repeat(np.arange(1, len(TEMPERATURES) + 1), ROWS)
    time = (np.arange(n) % ROWS) * SECONDS / ROWS + (number - 1) * (SECONDS + PAUSE)
    warm = np.repeat(TEMPERATURES, ROWS) + 0.4 * np.sin(time / 900)
    gap = GAP + PER_KELVIN * (warm - 20.0)
    angle = ZERO + torque / STIFFNESS * ARCSEC + np.sign(torque) * gap / 2
    angle += FRICTION / 2 * sliders(torque)
    shaking = np.zeros(n)
    for i in range(1, n):
        shaking[i] = 0.5 * shaking[i - 1] + rng.normal(0, 0.35 * np.sqrt(1 - 0.5**2))
    angle += shaking
    angle[[137, 401]] += (9.0, -12.0)
    read = torque + rng.normal(0, 0.002, n)
    felt = warm + rng.normal(0, 0.05, n)
    columns = zip(number, time, felt, read, np.round(angle, 1), strict=True)
    return [f"{c},{t:.1f},{w:.2f},{q:.4f},{a:.1f}" for c, t, w, q, a in columns]


def main() -> None:
    """Print the file."""
    out = sys.stdout
    out.write(
        "# MADE UP, not measured: written by make_sweep.py, which says what is hidden in it\n"
    )
    out.write("# gear of examples/xb1-40.toml, wave generator locked, soaked at six temperatures\n")
    out.write("cycle,time_s,temperature_C,torque_Nm,angle_arcsec\n")
    out.write("\n".join(lines(np.random.default_rng(SEED))) + "\n")


if __name__ == "__main__":
    main()
