"""What a cause is: a forward model on the whole torque history, linear in its amplitudes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import log
from typing import ClassVar, Literal

import numpy as np

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.prediction import Prediction

Shape = Mapping[str, float]
"""Shape parameters by name, each with its unit in the name."""
Effect = Literal["angle", "gap", "compliance"]
"""What of the torque-angle curve a cause changes."""


@dataclass(frozen=True)
class FitContext:
    """The prediction and the ranges of the record. They determine the grids of shapes and the sizes of
    effects.

    `compliance` [arcsec per N·m] and `gap_arcsec` are what was measured, all linear terms together;
    as predicted until something is fitted.
    """

    prediction: Prediction
    history: History
    measured: tuple[float, float] | None = None

    @property
    def compliance(self) -> float:
        return self.measured[0] if self.measured else self.prediction.compliance

    @property
    def gap_arcsec(self) -> float:
        return self.measured[1] if self.measured else self.prediction.gap_arcsec

    @property
    def largest_Nm(self) -> float:
        """Largest torque, of either sign."""
        return self.history.largest_Nm

    @cached_property
    def scale_arcsec(self) -> float:
        """Predicted angle at the largest torque."""
        return self.prediction.scale_arcsec(self.largest_Nm)

    @cached_property
    def cycles(self) -> int:
        """Number of cycles, of the unit that has most."""
        return int(self.history.cycle.max()) + 1

    @cached_property
    def duration_s(self) -> float:
        """Longest time of one unit; 0 where time is not recorded."""
        t = self.history.time_s
        if t is None:
            return 0.0
        return max(float(np.ptp(t[rows])) for rows in self.history.unit_slices)


@dataclass(frozen=True)
class Element:
    """One elementary term of a cause: a shape and its amplitudes (k,) in the cause's own unit."""

    shape: Shape
    amplitudes: tuple[float, ...]


class Cause(ABC):
    """One physical cause.

    Several elements of one cause may act at once, with different shapes: hysteresis is not one loop
    shape. The same object is the hypothesis and, later, the extension of the model.
    """

    id: ClassVar[str]
    """As in docs/contract.md."""
    title: ClassVar[str]
    """What a person reads: a noun phrase."""
    unit: ClassVar[str]
    """Of the magnitude."""
    ratio: ClassVar[str] = ""
    """Which ratio the magnitude is, if its unit is % or 1 (docs/contract.md)."""
    factor: ClassVar[str] = ""
    """Words after the number, such as "times as …", if the magnitude's unit is 1."""
    none: ClassVar[float] = 0.0
    """The magnitude of no effect."""
    passes_none: ClassVar[bool] = True
    """Whether the magnitude passes through `none` where the effect changes sign. Its standard deviation then
    tells it from none. The amplitude of a wave is above none for every phase."""
    positive: ClassVar[bool] = False
    """Whether physics forbids negative amplitudes."""
    exact: ClassVar[bool] = False
    """Whether the columns are the cause's only shape, so that it leaves no misfit."""
    elastic: ClassVar[bool] = False
    """Whether it changes the mean slope of angle over torque, so that the calibrated compliance is not this
    slope."""
    shape_doubt: ClassVar[float] = 0.007
    """Share of the magnitude by which the shapes tried may miss a real gear's.

    Chosen on made-up records with laws that are none of these shapes, so that one and two deviations
    cover about 68 and 95 % of them. What they cover is given beside each value, of 250 records of seed
    1050000: `python tests/hidden/run.py --seed 1050000 --kind single --records 170`, 60 pairs, 20 triples.
    This one is for a cause of which no such records have been made yet.
    """
    spread_share: ClassVar[float]
    """`spread` as a share of the predicted twist, angle or compliance, if it is such a share."""
    per_torque: ClassVar[bool] = False
    """Whether amplitudes are in arcsec per N·m: `spread` is then a share of the predicted compliance."""
    needs_time: ClassVar[bool] = False
    """Whether it cannot be identified without recorded time."""
    vary: ClassVar[str] = "torque_Nm"
    """What to vary to make it visible if the rivals' predictions do not decide: a channel, or torque_rate,
    torque_amplitude, hold."""
    shows_over: ClassVar[str] = "torque_Nm"
    """The channel over which a chart shows it best."""
    shows_as: ClassVar[Effect] = "angle"
    """What that chart draws: the added angle, gap or compliance."""
    tunable: ClassVar[tuple[str, ...]] = ()
    """Continuous shape parameters, which are refined around the best of `shapes` by steps of up to a factor
    e^½ (`sweep/evidence/shape_tuning.py`): in a grid of them, neighbours need be no nearer than a factor
    of e."""
    made_of: ClassVar[frozenset[str]] = frozenset()
    """Ids of other causes that together can imitate this one. If they are found, this cause is tried in the
    place of all of them."""
    searched_apart: ClassVar[tuple[Shape, ...]] = ()
    """Shapes that change the history that other causes see, one for each set of parameters; they are not
    among `shapes`."""
    reveals: ClassVar[str]
    """The measurement that shows this cause most plainly."""

    def title_at(self, magnitude: float) -> str:
        """Title by the sign of the magnitude, if the sign changes the meaning."""
        return self.title

    @abstractmethod
    def shapes(self, rig: FitContext) -> list[Shape]:
        """Shapes to try on a rig's record; none if the record lacks the channel."""

    def log_share(self, shape: Shape, count: int) -> float:
        """Log of the share of the cause's prior that one of `count` shapes has."""
        return -log(count)

    def stands_alone(self, shape: Shape) -> bool:
        """Whether an element of this shape excludes a second element of the cause."""
        return False

    def plausible(self, elements: Sequence[Element], rig: FitContext) -> bool:
        """Whether a real gear may have these elements on a record. It is checked if they would stand in for
        another cause."""
        return True

    def possible(self, shape: Shape) -> bool:
        """Whether refining may go as far as this shape."""
        return True

    def kind(self, shape: Shape) -> tuple[float | str, ...]:
        """The parameters of a shape that refinement does not change."""
        return tuple(v for k, v in sorted(shape.items()) if k not in self.tunable)

    def law(self, shape: Shape) -> tuple[float | str, ...]:
        """Its kind, and the names of the parameters that are refined."""
        return (*self.kind(shape), *(k for k in self.tunable if shape.get(k, 0.0) > 0))

    def but_for_a_spring(self, shape: Shape, rig: FitContext) -> list[Shape]:
        """Shapes that differ from this one by twist in proportion to torque alone.

        Together with a spring they fit a record equally well, but give the spring another size.
        """
        return []

    @abstractmethod
    def columns(self, shape: Shape, history: History) -> np.ndarray:
        """(n, k) angle [arcsec] for one unit of each of the k amplitudes."""

    def columns_of_all(self, shapes: Sequence[Shape], history: History) -> list[np.ndarray]:
        """Columns of several shapes at once."""
        return [self.columns(shape, history) for shape in shapes]

    def spread(self, shape: Shape, rig: FitContext) -> float:
        """Prior standard deviation of an amplitude: the size that such effects have in real gears.

        Shares of the predicted twist or angle, by judgement; they need not be accurate. Half of all of them
        changes one verdict of 34 made-up records (`tests/hidden`, seed 77: `ambiguous` becomes `named`),
        twice all of them none. The default is a share of the predicted compliance (`per_torque`) or angle.
        """
        whole = rig.prediction.compliance if self.per_torque else rig.scale_arcsec
        return self.spread_share * whole

    def magnitude(self, elements: Sequence[Element], rig: FitContext) -> float:
        """The magnitude (docs/contract.md) of all elements together, in `unit`.

        The default is the sum of their first amplitudes.
        """
        return sum(e.amplitudes[0] for e in elements)

    def angle_arcsec(self, elements: Sequence[Element], history: History) -> np.ndarray:
        """(n,) what the elements add to the angle."""
        total = np.zeros(len(history))
        for e in elements:
            total += self.columns(e.shape, history) @ np.array(e.amplitudes)
        return total

    def corrected(self, elements: Sequence[Element], history: History) -> History:
        """The true history, where the cause is an error of the reading."""
        return history

    def at_teeth(self, elements: Sequence[Element], history: History) -> History:
        """The history with the torque that reaches the teeth, where the cause lies ahead of them."""
        return history
