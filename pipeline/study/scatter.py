"""What a tolerance study tells: distribution, Sobol indices, and what a tighter tolerance buys."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry.errors import ComputationError
from pipeline.study.store import Row
from pipeline.study.tolerance import Input, problem

CONFIDENCE = 0.95
RESAMPLES = 200
FACTORS = (0.75, 0.5, 0.25, 0.0)
"""A tolerance times this; 0 is a perfect part."""
SURFACE_POINTS = 2**13


class ScatterError(ComputationError):
    """Too few designs could be built to say anything; `kept` of `blocks`."""

    def __init__(self, kept: int, blocks: int) -> None:
        self.kept, self.blocks = kept, blocks
        super().__init__(
            f"only {kept} of {blocks} sample blocks could be built and solved; narrow [tolerance]"
        )


@dataclass(frozen=True)
class Indices:
    """Sobol indices of each input (k,), first order and total, with ± of CONFIDENCE."""

    first: np.ndarray
    first_conf: np.ndarray
    total: np.ndarray
    total_conf: np.ndarray


@dataclass(frozen=True)
class Tightened:
    """One input with its scatter times `factor`: width of the 95 % range, and what that saves."""

    key: str
    factor: float
    width: float
    bought: float


@dataclass(frozen=True)
class Scatter:
    """One figure's scatter, in the figure's unit.

    Attributes
    ----------
    values : (2N,) of the two independent samples.
    low, high : ends of the 95 % range.
    indices : by input.
    tightened : by input and factor, from a quadratic surface through all designs.
    surface_rms : what that surface misses, root mean square.
    dropped : sample blocks left out because a design of theirs could not be built.
    """

    key: str
    inputs: tuple[Input, ...]
    values: np.ndarray
    mean: float
    std: float
    low: float
    high: float
    indices: Indices
    tightened: tuple[Tightened, ...]
    surface_rms: float
    dropped: int


def scatter_of(key: str, inputs: tuple[Input, ...], rows: tuple[Row, ...], seed: int) -> Scatter:
    """From the rows of a whole tolerance study, in order.

    Raises
    ------
    ScatterError
    """
    k = len(inputs)
    points = np.array([[r.values[x.key] for x in inputs] for r in rows])
    values = np.array([r.outcome.figures.get(key, np.nan) for r in rows])
    blocks = values.reshape(-1, k + 2)
    whole = np.isfinite(blocks).all(axis=1)
    if whole.sum() < 4:
        raise ScatterError(int(whole.sum()), len(blocks))
    kept = np.repeat(whole, k + 2)
    points, values, blocks = points[kept], values[kept], blocks[whole]
    independent = np.concatenate([blocks[:, 0], blocks[:, -1]])
    low, high = np.quantile(independent, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    tightened, rms = tightening(inputs, points, values, seed)
    return Scatter(
        key, inputs, independent, float(independent.mean()), float(independent.std(ddof=1)),
        float(low), float(high), sobol_indices(inputs, values, seed), tightened, rms,
        int((~whole).sum()),
    )  # fmt: skip


def sobol_indices(inputs: tuple[Input, ...], values: np.ndarray, seed: int) -> Indices:
    """From values at the points of `saltelli`, by SALib."""
    from SALib.analyze import sobol

    if np.ptp(values) == 0:
        nothing = np.zeros(len(inputs))
        return Indices(nothing, nothing, nothing, nothing)
    found = sobol.analyze(
        problem(inputs), values, calc_second_order=False, num_resamples=RESAMPLES,
        conf_level=CONFIDENCE, seed=seed,
    )  # fmt: skip
    names = ("S1", "S1_conf", "ST", "ST_conf")
    return Indices(*(np.asarray(found[n], float) for n in names))


def tightening(
    inputs: tuple[Input, ...], points: np.ndarray, values: np.ndarray, seed: int
) -> tuple[tuple[Tightened, ...], float]:
    """What every input's tightening buys of the 95 % range, and the surface's rms error.

    A quadratic in the standardised inputs is drawn through all designs; its range is taken over
    SURFACE_POINTS Sobol points of the tightened inputs, the same points each time, so that the
    differences are the tightening's own.
    """
    from scipy.stats import qmc

    def terms(x: np.ndarray) -> np.ndarray:
        z = (x - np.array([i.nominal for i in inputs])) / np.array([i.std for i in inputs])
        columns = [np.ones(len(z)), *z.T]
        if len(values) >= 2 * (len(inputs) + 1) * (len(inputs) + 2) // 2:
            columns += [z[:, i] * z[:, j] for i in range(z.shape[1]) for j in range(i + 1)]
        return np.column_stack(columns)

    surface, *_ = np.linalg.lstsq(terms(points), values, rcond=None)
    rms = float(np.sqrt(np.mean((terms(points) @ surface - values) ** 2)))
    unit = qmc.Sobol(len(inputs), scramble=True, seed=seed).random(SURFACE_POINTS)

    def width(changed: tuple[Input, ...]) -> float:
        x = np.column_stack(
            [i.at(unit[:, c]) if i.std else np.full(len(unit), i.nominal)
             for c, i in enumerate(changed)]
        )  # fmt: skip
        ends = np.quantile(terms(x) @ surface, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
        return float(ends[1] - ends[0])

    now = width(inputs)
    found = []
    for i, own in enumerate(inputs):
        for factor in FACTORS:
            changed = (*inputs[:i], own.tightened(factor), *inputs[i + 1 :])
            wide = width(changed)
            found.append(Tightened(own.key, factor, wide, now - wide))
    return tuple(found), rms
