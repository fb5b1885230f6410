"""Shortens long records by averaging and selection, so that the same effects stay visible."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexspline.pipeline.diagnosis.measurement.corners import corners_of
from flexspline.pipeline.diagnosis.measurement.crossing_band import crossing_band_Nm
from flexspline.pipeline.diagnosis.measurement.encoder_step import encoder_step
from flexspline.pipeline.diagnosis.measurement.floors import LEAST_ANGLE_ARCSEC
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.moving_mean import moving_mean
from flexspline.pipeline.diagnosis.measurement.record import Averaging, Sweep
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.robust import robust_std

MOST_FIT_ROWS = 6000
"""A design matrix of 600 columns then takes 14 MB in float32."""
FEWEST_PER_CYCLE = 150
"""Fewest rows of a cycle that remain. A block is then far shorter than the crossing's band."""
NOISE_SIGMAS = 4.0
"""Standard deviations of the torque's noise. A reading farther from those about it is a step of the torque;
noise alone makes one of 16 000."""
LEAST_ROUNDED = 0.1
"""Share of the rounding of the sharpest corner by a block's mean. A smaller rounding is a bend. Judgement."""
SPIKE = 6.0
"""Standard deviations from the mean of both neighbours; one row of normal noise in 500 million."""


def thinned(sweep: Sweep) -> Sweep:
    """A record of some 6000 rows, and what stays single: means over blocks of neighbouring rows of one cycle.

    Torque, angle and every channel are averaged over the same rows, so a straight branch stays what it
    was. The row at a corner of the torque stays single: what has a memory remembers how far the torque went.
    Where the torque's noise hides which row that is, blocks end at the corner, within some rows. Spikes of
    single rows are taken out first. Where cycles are many and short, whole cycles are left out instead,
    evenly.
    """
    n = len(sweep)
    if n <= MOST_FIT_ROWS:
        return sweep
    h = sweep.history
    keys = h.unit_and_cycle
    labels, at, counts = np.unique(keys, return_index=True, return_counts=True)
    block = int(np.ceil(n / MOST_FIT_ROWS))
    if np.median(counts) / block < FEWEST_PER_CYCLE:
        block = max(1, int(np.median(counts) // FEWEST_PER_CYCLE))
    torque, corner = _steady(h, block)
    near = (np.abs(torque) < crossing_band_Nm(h)) & _passing(h, torque, block)
    at_corners = _rows_at_corners(h, keys, block)
    groups: list[np.ndarray] = []
    for label in _spared(labels, h.unit[at], counts, block):
        rows = np.flatnonzero(keys == label)
        rows = rows[corner[rows] | ~_spikes(sweep.angle_arcsec[rows])]
        single = near[rows] | corner[rows] | _beside_jumps(sweep.angle_arcsec[rows])
        groups += _blocks(rows, single, np.searchsorted(rows, at_corners), block)
    first = np.array([g[0] for g in groups])
    order = np.argsort(first)
    groups = [groups[i] for i in order]
    return _averaged(sweep, groups, first[order], torque, block)


def _steady(history: History, block: int) -> tuple[np.ndarray, np.ndarray]:
    """(n,) torque of each row, by the rows about it where they differ by noise; (n,) the rows at its corners.

    Its own reading, noisier than a mean over a block, would choose which rows count as near a limit.
    """
    torque = _smooth(history.unit_slices, history.torque_Nm, block)
    rounded, noise = np.abs(history.torque_Nm - torque), torque_noise_Nm(history)
    as_written = float(np.median(rounded))  # the last digit's rounding, where there is no noise
    about = rounded > max(SPIKE * max(noise, as_written), LEAST_ROUNDED * float(rounded.max()))
    corner = np.zeros(len(history), bool)
    for run in np.split(np.arange(len(about)), np.flatnonzero(np.diff(about)) + 1):
        corner[run[np.argmax(rounded[run])]] = about[run[0]]
    return np.where(rounded > NOISE_SIGMAS * noise, history.torque_Nm, torque), corner


def _smooth(stretches: list[np.ndarray], values: np.ndarray, block: int) -> np.ndarray:
    """(n,) means over a block of rows about each row, within its stretch of rows."""
    smooth = np.empty(len(values))
    for rows in stretches:
        smooth[rows], _ = moving_mean(values[rows], block // 2)
    return smooth


def _passing(history: History, steady_Nm: np.ndarray, block: int) -> np.ndarray:
    """(n,) whether torque moves beyond its noise from one block to the next: a mean says less then."""
    moved = np.zeros(len(history))
    for rows in history.unit_slices:
        at = np.arange(len(rows))
        after, before = (np.clip(at + k, 0, len(rows) - 1) for k in (block, -block))
        moved[rows] = np.abs(steady_Nm[rows[after]] - steady_Nm[rows[before]])
    return moved > NOISE_SIGMAS * torque_noise_Nm(history) * np.sqrt(2 / block)


def _rows_at_corners(history: History, keys: np.ndarray, block: int) -> np.ndarray:
    """(k,) rows at which the torque's programme turns a corner, as means over whole blocks show it.

    Single readings show it less, the noisier they are.
    """
    if history.time_s is None:
        return np.zeros(0, int)
    of_block = np.arange(len(history)) // block
    first = np.flatnonzero(np.diff(of_block, prepend=-1) | np.diff(keys, prepend=keys[0] - 1))
    count = np.diff(first, append=len(history))

    def mean(values: np.ndarray) -> np.ndarray:
        return np.add.reduceat(values, first) / count

    means = History(
        mean(history.torque_Nm), history.unit[first], history.cycle[first], mean(history.time_s)
    )
    starts = [rows[0] for rows in history.unit_slices]
    return np.array([
        starts[c.unit] + np.searchsorted(history.time_s[history.unit_slices[c.unit]], c.time_s)
        for c in corners_of(means)
    ], int)  # fmt: skip


def _blocks(
    rows: np.ndarray, near: np.ndarray, at_corners: np.ndarray, block: int
) -> list[np.ndarray]:
    """Blocks of neighbouring rows (m,), none over a corner; each row near the gap's crossing stays by itself.

    A mean over both sides of the gap, or of a friction loop, is on neither.
    """
    edges = np.union1d(np.flatnonzero(np.diff(near.astype(int)) != 0) + 1, at_corners)
    edges = edges[(edges > 0) & (edges < len(rows))]
    blocks: list[np.ndarray] = []
    for part, inside in zip(np.split(rows, edges), np.split(near, edges), strict=True):
        if len(part):
            count = len(part) if inside[0] else max(1, len(part) // block)
            blocks += np.array_split(part, count)
    return blocks


def _spared(labels: np.ndarray, units: np.ndarray, counts: np.ndarray, block: int) -> np.ndarray:
    """Cycles that are kept, so that few enough rows remain; the first and the last of each unit always.

    Of each cycle its label, its unit and the number of its rows.
    """
    share = MOST_FIT_ROWS / max(1.0, np.median(counts) / block) / len(labels)
    if share >= 1:
        return labels
    kept = []
    for unit in np.unique(units):
        own = labels[units == unit]
        many = max(2, int(share * len(own)))
        kept.append(own[np.unique(np.linspace(0, len(own) - 1, many).round().astype(int))])
    return np.concatenate(kept)


def _beside_jumps(angle: np.ndarray) -> np.ndarray:
    """Rows on either side of a jump: a reading that is shifted is not near zero where the gap is crossed."""
    beside = np.zeros(len(angle), bool)
    if len(angle) < 5:
        return beside
    changes = np.pad(np.diff(angle), 1, mode="reflect")  # the first and the last may jump too
    jumps = _off_their_neighbours(changes)[1:-1]
    beside[:-1] |= jumps
    beside[1:] |= jumps
    return beside


def _spikes(angle: np.ndarray) -> np.ndarray:
    """Rows far from both neighbours."""
    return np.zeros(len(angle), bool) if len(angle) < 5 else _off_their_neighbours(angle)


def _off_their_neighbours(values: np.ndarray) -> np.ndarray:
    """Which values lie far off the mean of both neighbours: they pull their neighbours' too, by half."""
    off = np.zeros(len(values))
    off[1:-1] = values[1:-1] - (values[:-2] + values[2:]) / 2
    size = np.abs(off)
    far = np.zeros(len(values), bool)
    far[1:-1] = _beyond_scatter(off[1:-1])
    return far & (size >= np.maximum(np.roll(size, 1), np.roll(size, -1)))


def _beyond_scatter(angle: np.ndarray) -> np.ndarray:
    """Which differences of angles lie SPIKE deviations from their median, or more."""
    off = np.abs(angle - np.median(angle))
    return np.asarray(off > SPIKE * (robust_std(off) + LEAST_ANGLE_ARCSEC))


def _averaged(
    sweep: Sweep, groups: list[np.ndarray], first: np.ndarray, steady_Nm: np.ndarray, block: int
) -> Sweep:
    """Rows that stay single have the steady torque (n,) and the temperature about them: as noisy as means."""

    def mean(values: np.ndarray) -> np.ndarray:
        return np.array([values[g].mean() for g in groups])

    def maybe(values: np.ndarray | None) -> np.ndarray | None:
        return None if values is None else mean(values)

    h = sweep.history
    torque, angle = mean(h.torque_Nm), mean(sweep.angle_arcsec)
    rows, sizes = np.concatenate(groups), [len(g) for g in groups]
    off_torque = h.torque_Nm[rows] - np.repeat(torque, sizes)
    off = sweep.angle_arcsec[rows] - np.repeat(angle, sizes)
    within = off @ off, off @ off_torque, off_torque @ off_torque
    alone = np.array(sizes) == 1
    torque[alone] = steady_Nm[first[alone]]
    temperature = maybe(h.temperature_C)
    if temperature is not None and h.temperature_C is not None:
        temperature[alone] = _smooth(h.cycle_slices, h.temperature_C, block)[first[alone]]
    history = History(
        torque, h.unit[first], h.cycle[first],
        maybe(h.time_s), temperature,
        None if h.input_angle_deg is None else h.input_angle_deg[first], np.array(sizes),
        number=mean(h.time_or_rows(np.arange(len(sweep)))) if h.time_s is None else None,
    )  # fmt: skip
    return replace(
        sweep, history=history, angle_arcsec=angle, line=sweep.line[first],
        averaging=Averaging(len(sweep), len(rows), within, encoder_step(sweep.angle_arcsec)),
        went_to=_went_to(sweep, groups),
    )  # fmt: skip


def _went_to(sweep: Sweep, groups: list[np.ndarray]) -> np.ndarray:
    """Of each data row of the file, the group that it is in, −1 of none."""
    group = np.full(len(sweep), -1)
    for i, rows in enumerate(groups):
        group[rows] = i
    if sweep.went_to is None:
        return group
    return np.where(sweep.went_to >= 0, group[sweep.went_to], -1)
