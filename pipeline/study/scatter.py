"""Results of a tolerance study: distribution, Sobol indices, and the gain from tighter tolerances.

All three come from one quadratic surface where that leaves every index known; else the distribution and
the indices come from the sample, and there is no tightening; indices that neither knows are not given.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.indices import CONFIDENCE, WIDEST_INTERVAL, Indices, sampled_indices
from flexspline.pipeline.study.response_surface import ResponseSurface, surface_through
from flexspline.pipeline.study.tolerance import ScatteredInput

TIGHTENING_FACTORS = (0.75, 0.5, 0.25, 0.0)
"""A tolerance times this; 0 is a perfect part."""
SURFACE_POINTS = 2**13
"""Of a Sobol sequence, a power of 2 as its balance needs; the surface costs nothing to evaluate."""
LEAST_BLOCKS = 4
"""Sample blocks from which a distribution says something: eight independent designs."""
CONSTANT_SHARE = 1e-9
"""Of a figure's size: a range below it is rounding."""


class ScatterError(ComputationError):
    """Too few designs could be built to say anything; `kept` of `blocks`."""

    def __init__(self, kept: int, blocks: int) -> None:
        self.kept, self.blocks = kept, blocks
        super().__init__(
            f"only {kept} of {blocks} sample blocks could be built and solved; narrow [tolerance]"
        )


@dataclass(frozen=True)
class Tightened:
    """One input with its scatter times `factor`: width of the 95 % range, and what that saves."""

    key: str
    factor: float
    width: float
    bought: float


@dataclass(frozen=True)
class Attribution:
    """Shares of the variance by input.

    Attributes
    ----------
    indices : by input; None where neither surface nor sample knows them well enough.
    surface : where it gives the indices.
    explained : Q² of the surface tried, used or not; None where the designs were too few for one.
    enough : so many evaluations may give indices from the sample, where there are none.
    """

    indices: Indices | None = None
    surface: ResponseSurface | None = None
    explained: float | None = None
    enough: int | None = None


@dataclass(frozen=True)
class Scatter:
    """One figure's scatter, in the figure's unit.

    Attributes
    ----------
    values : of the independent designs of the sample.
    drawn : what the distribution is taken from: the surface with its errors, or `values`.
    low, high : ends of the 95 % range.
    shares : of the variance, by input; None where the figure is constant.
    tightened : by input and factor, where there is a surface.
    dropped : designs that could not be built or solved.
    """

    key: str
    inputs: tuple[ScatteredInput, ...]
    values: np.ndarray
    drawn: np.ndarray
    low: float
    high: float
    shares: Attribution | None = None
    tightened: tuple[Tightened, ...] = ()
    dropped: int = 0

    @property
    def indices(self) -> Indices | None:
        return self.shares.indices if self.shares else None

    @property
    def surface(self) -> ResponseSurface | None:
        return self.shares.surface if self.shares else None

    @property
    def mean(self) -> float:
        return float(self.drawn.mean())

    @property
    def std(self) -> float:
        return float(self.drawn.std(ddof=1))

    @property
    def order(self) -> tuple[int, ...]:
        """Inputs, the most important first; in their own order where the indices are not known."""
        if self.indices is None:
            return tuple(range(len(self.inputs)))
        total = self.indices.total
        return tuple(sorted(range(len(self.inputs)), key=lambda i: -total[i]))


def scatter_of(
    key: str, inputs: tuple[ScatteredInput, ...], rows: tuple[Row, ...], seed: int
) -> Scatter:
    """Return a figure's scatter from the rows of a whole tolerance study, in order.

    Raises
    ------
    ScatterError
    """
    k = len(inputs)
    points = np.array([[r.values[x.key] for x in inputs] for r in rows])
    values = np.array([r.outcome.figures.get(key, np.nan) for r in rows])
    blocks, solved = values.reshape(-1, k + 2), np.isfinite(values)
    whole = np.isfinite(blocks).all(axis=1)
    if whole.sum() < LEAST_BLOCKS:
        raise ScatterError(int(whole.sum()), len(blocks))
    independent = blocks[:, [0, -1]].ravel()
    independent = independent[np.isfinite(independent)]
    dropped = int((~solved).sum())
    if np.ptp(values[solved]) <= CONSTANT_SHARE * np.abs(values[solved]).max():
        same = float(independent.mean())
        return Scatter(key, inputs, independent, independent, same, same, dropped=dropped)

    attribution = attributed(inputs, points, values)
    if attribution.surface is None:
        return Scatter(
            key, inputs, independent, independent, *_ends(independent), attribution, (), dropped
        )  # fmt: skip
    cloud = Cloud(attribution.surface, seed)
    drawn = cloud.values(inputs)
    return Scatter(
        key, inputs, independent, drawn, *_ends(drawn), attribution, tightening(cloud), dropped
    )


def attributed(
    inputs: tuple[ScatteredInput, ...], points: np.ndarray, values: np.ndarray
) -> Attribution:
    """Return shares of the variance from points (n, k) and values (n,), nan where unsolved (Saltelli)."""
    k = len(inputs)
    blocks, solved = values.reshape(-1, k + 2), np.isfinite(values)
    block = np.repeat(np.arange(len(blocks)), k + 2)
    surface = surface_through(inputs, points[solved], values[solved], block[solved])
    explained = surface.explained if surface else None
    if surface and (indices := surface.indices()).is_known:
        return Attribution(indices, surface, explained)
    whole = blocks[np.isfinite(blocks).all(axis=1)]
    if len(whole) < LEAST_BLOCKS or np.ptp(whole[:, [0, -1]]) == 0:
        return Attribution(explained=explained)
    indices, half = sampled_indices(whole)
    if half <= WIDEST_INTERVAL:
        return Attribution(indices, explained=explained)
    more = np.ceil(np.log2(len(blocks) * (half / WIDEST_INTERVAL) ** 2))
    return Attribution(explained=explained, enough=int(2**more) * (k + 2))


class Cloud:
    """A surface over SURFACE_POINTS Sobol points, and its errors at designs left out, dealt at random.

    The same points and errors whatever the inputs' scatter, so that differences are the scatter's own.
    """

    def __init__(self, surface: ResponseSurface, seed: int) -> None:
        from scipy.stats import qmc

        self.surface = surface
        self._unit = qmc.Sobol(len(surface.inputs), scramble=True, seed=seed).random(SURFACE_POINTS)
        dealt = np.resize(surface.errors, SURFACE_POINTS)
        self._errors = np.random.default_rng(seed).permutation(dealt)

    def values(self, inputs: tuple[ScatteredInput, ...]) -> np.ndarray:
        """Return the figure for inputs that scatter less than the surface's own, or as much."""
        x = np.column_stack([i.at(u) for i, u in zip(inputs, self._unit.T, strict=True)])
        return np.asarray(self.surface.at(x) + self._errors)

    def ends(self, inputs: tuple[ScatteredInput, ...]) -> tuple[float, float]:
        """Return the ends of the 95 % range."""
        return _ends(self.values(inputs))


def tightening(cloud: Cloud) -> tuple[Tightened, ...]:
    """Return how much narrower the 95 % range becomes if an input is tightened, for each input."""
    inputs = cloud.surface.inputs
    now = float(np.ptp(cloud.ends(inputs)))
    gains = []
    for i, scattered in enumerate(inputs):
        for factor in TIGHTENING_FACTORS:
            width = float(
                np.ptp(cloud.ends((*inputs[:i], scattered.tightened(factor), *inputs[i + 1 :])))
            )
            gains.append(Tightened(scattered.key, factor, width, now - width))
    return tuple(gains)


def _ends(values: np.ndarray) -> tuple[float, float]:
    low, high = np.quantile(values, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return float(low), float(high)
