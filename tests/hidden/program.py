"""What the rig does: torque in time, where the samples fall, where the wave generator stands."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from hidden.surroundings import input_positions, temperature

WAVES = ("triangle", "sine", "staircase", "trapezoid")
TIMED = ("time_s", "cycle", "temperature_C", "input_angle_deg")


@dataclass(frozen=True)
class Program:
    """One unit's history on a grid finer than the samples; every array has the same length.

    Attributes
    ----------
    time : s. torque : N·m, true. progress : cycles done, fractional. cycle : whole number, from 1.
    temperature : °C, of the air. position : deg, where the wave generator is locked.
    rows : indices of the grid that are recorded; the grid may begin before them, at times below 0.
    hold, typical_hold : s, the shortest and the median hold; 0 where there is none.
    quickest : s, the shortest cycle.
    columns : optional columns that the file has.
    """

    time: np.ndarray
    torque: np.ndarray
    progress: np.ndarray
    cycle: np.ndarray
    temperature: np.ndarray
    position: np.ndarray
    rows: np.ndarray
    hold: float
    typical_hold: float
    quickest: float
    columns: tuple[str, ...]
    said: str

    @property
    def peak(self) -> float:
        """Largest |torque| [N·m]."""
        return float(np.abs(self.torque).max())

    @property
    def load(self) -> np.ndarray:
        """Torque / peak."""
        return self.torque / self.peak

    @property
    def rate(self) -> np.ndarray:
        """dT/dt [N·m/s] of the step that ends at each grid point."""
        dt = np.diff(self.time)
        rate = np.diff(self.torque) / dt
        return np.concatenate([rate[:1], rate])


@dataclass(frozen=True)
class Plan:
    """Choices that a case prescribes; None leaves them to the draw."""

    wave: tuple[str, ...] = WAVES
    cycles: tuple[int, int] = (2, 8)
    several_rates: bool | None = None
    several_peaks: bool | None = None
    air: tuple[str, ...] = ("none", "constant", "ramp", "oven", "heating", "shuffled", "swing")
    places: tuple[str, ...] = ("none", "constant", "even", "random", "revisited")
    with_columns: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    one_sided: bool = False
    rows: tuple[int, int] = (300, 3000)
    extra: dict[str, float] = field(default_factory=dict)
    unrecorded: float = 0.25


def draw_program(plan: Plan, peak: float, rng: np.random.Generator) -> Program:
    """A torque programme that keeps to the plan; peak in N·m."""
    wave = str(rng.choice(plan.wave))
    n = int(rng.integers(plan.cycles[0], plan.cycles[1] + 1))
    several = rng.random() < 0.5 if plan.several_rates is None else plan.several_rates
    amplitudes = rng.random() < 0.35 if plan.several_peaks is None else plan.several_peaks
    period = float(np.exp(rng.uniform(np.log(20), np.log(600))))
    periods = period * _per_cycle(several, rng.choice([2.0, 3.0, 5.0]), n, rng)
    peaks = peak / _per_cycle(amplitudes, rng.choice([1.5, 2.0, 3.0]), n, rng)
    peaks *= peak / peaks.max()
    phase, level = _wave(wave, rng)
    level = np.abs(level) if plan.one_sided else level
    start = np.concatenate([[0], np.cumsum(periods)])
    t = (start[:-1, None] + periods[:, None] * phase).ravel()
    q = (peaks[:, None] * level).ravel()
    before = rng.random() < plan.unrecorded
    if before:  # the gear was worked once, and nobody wrote it down: friction does not start fresh
        t = np.concatenate([periods[0] * (phase[:-1] - 1), t])
        q = np.concatenate([peaks[0] * level[:-1], q])
    keep = np.concatenate([[True], np.diff(t) > 1e-9])
    t, q = t[keep], q[keep]
    count = int(np.exp(rng.uniform(*np.log(plan.rows))))
    samples, sampling = _samples(start, count, rng)
    middle = (samples[1:] + samples[:-1]) / 2
    time = np.unique(np.concatenate([samples, middle, t]))
    progress = np.interp(time, start, np.arange(n + 1.0))
    cycle = np.minimum(np.floor(progress + 1e-9), n - 1).astype(int)
    air = str(rng.choice(plan.air))
    place = str(rng.choice(plan.places))
    columns = _columns(plan, air, place, rng)
    flats = np.diff(t)[np.diff(q) == 0]
    also = [
        *(["several rates"] if several else []),
        *(["several peaks"] if amplitudes else []),
        *(["worked before"] if before else []),
    ]
    said = (
        f"{', '.join([wave, f'{n} cycles of {period:.0f} s', *also])}, peak {peak:.3g} N·m, {count} rows "
        f"{sampling}, air {air}, positions {place}, columns {'+'.join(columns) or 'none'}"
    )
    return Program(
        time=time,
        torque=np.interp(time, t, q),
        progress=progress,
        cycle=cycle + 1,
        temperature=temperature(air, time, progress, n, rng, plan.extra),
        position=input_positions(place, n, rng)[cycle],
        rows=np.searchsorted(time, samples),
        hold=float(flats.min()) if len(flats) else 0.0,
        typical_hold=float(np.median(flats)) if len(flats) else 0.0,
        quickest=float(periods.min()),
        columns=columns,
        said=said,
    )


def _per_cycle(several: bool, ratio: float, n: int, rng: np.random.Generator) -> np.ndarray:
    """A factor for every cycle: 1, or two or three values in any order, each at least once."""
    if not several:
        return np.ones(n)
    values = np.array([1.0, ratio] if n < 4 or rng.random() < 0.5 else [1.0, ratio**0.5, ratio])
    return rng.permutation(np.resize(values, n))


def _wave(wave: str, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Knots (phase in 0…1, load in −1…1) of one cycle 0 → + → 0 → − → 0."""
    if wave == "triangle":
        return np.array([0, 0.25, 0.5, 0.75, 1]), np.array([0.0, 1, 0, -1, 0])
    if wave == "sine":
        u = np.linspace(0, 1, 241)
        return u, np.sin(2 * np.pi * u)
    levels = int(rng.integers(2, 6)) if wave == "staircase" else 1
    up = np.arange(1, levels + 1) / levels
    stops = np.concatenate([up, up[-2::-1], -up, -up[-2::-1]])
    held = rng.uniform(0.5, 0.85)
    u, y, phase = [0.0], [0.0], 0.0
    travel = np.abs(np.diff(np.concatenate([[0], stops, [0]])))
    for k, stop in enumerate(stops):  # ramps share what holds leave, by their travel
        phase += (1 - held) * travel[k] / travel.sum()
        u.append(phase)
        y.append(float(stop))
        phase += held / len(stops)
        u.append(phase)
        y.append(float(stop))
    return np.array([*u, 1.0]), np.array([*y, 0.0])


def _samples(start: np.ndarray, count: int, rng: np.random.Generator) -> tuple[np.ndarray, str]:
    """Sample times [s] from 0 to the end, and in words how they fall."""
    kind = str(rng.choice(["even", "jittered", "random", "same number in each cycle"]))
    n, end = len(start) - 1, start[-1]
    if kind == "random":
        t = np.concatenate([[0, end], rng.uniform(0, end, count - 2)])
    elif kind.startswith("same"):
        t = np.interp(np.linspace(0, n, count), np.arange(n + 1), start)
    else:
        t = np.linspace(0, end, count)
    if kind == "jittered":
        t[1:-1] += rng.uniform(-0.45, 0.45, count - 2) * end / (count - 1)
    return np.unique(np.round(t, 4)), kind


def _columns(plan: Plan, air: str, place: str, rng: np.random.Generator) -> tuple[str, ...]:
    chance = {
        "time_s": 0.94,
        "cycle": 0.9,
        "temperature_C": 0.0 if air == "none" else 0.95,
        "input_angle_deg": 0.0 if place == "none" else 0.95,
    }
    there = {c: rng.random() < p for c, p in chance.items()}
    there |= dict.fromkeys(plan.with_columns, True) | dict.fromkeys(plan.without, False)
    return tuple(c for c in TIMED if there[c])
