"""Whether a shape read from a file is one that its cause could have had, and what channels it needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from flexspline.geometry.listed import joined
from flexspline.pipeline.diagnosis.causes.cause import Cause, Element, FitContext, Shape
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.prediction import Prediction

CHANNELS = ("time_s", "temperature_C", "input_angle_deg")
"""That a record may lack."""


def example_history(
    largest_Nm: float = 1.0, ramp_s: float = 30.0, cycles: int = 4, held: int = 12, rested: int = 0
) -> History:
    """A record with every channel: triangles, `held` rows of hold at either end, warming, at many positions.

    And `rested` rows at zero after each triangle.

    A little noise on the torque, always the same: shapes may be given its size. All numbers are made up: only
    the names of a shape's parameters, and values that no record changes, are read from it.
    """
    quarter = np.arange(1, 11) / 10
    one = np.concatenate(
        [
            quarter, np.ones(held), 1 - 2 * np.arange(1, 21) / 20, -np.ones(held), quarter - 1,
            np.zeros(rested),
        ]
    )  # fmt: skip
    n = len(one) * cycles
    noise = np.random.default_rng(0).normal(0.0, 0.002, n)
    torque = largest_Nm * (np.tile(one, cycles) + noise)
    time = np.arange(1, n + 1) * ramp_s / 10
    cycle = np.repeat(np.arange(cycles), len(one))
    return History(torque, np.zeros(n, int), cycle, time, 20 + 15 * time / time[-1], 37.0 * cycle)


def fault_of(cause: Cause, shape: Shape, amplitudes: int) -> str | None:
    """What is wrong with a shape and its number of amplitudes, in words; None where nothing is.

    A shape must have the names of one that the cause tries on some record. Parameters that take the
    same few values on any record, such as the number of a law, must have one of these.
    """
    names, fixed = _known(cause)
    given = frozenset(shape)
    if given not in names:
        known = joined(("{" + ", ".join(sorted(n)) + "}" for n in sorted(names, key=len)), "or")
        return f"has the parameters {{{', '.join(sorted(given))}}}; it takes {known}"
    for name, values in fixed.items():
        if name in shape and shape[name] not in values:
            return f"has {name} = {shape[name]:g}; it takes {', '.join(f'{v:g}' for v in sorted(values))}"
    history = example_history()
    with np.errstate(all="ignore"):
        try:
            columns = cause.columns(shape, history)
            teeth = cause.at_teeth([Element(shape, (1.0,) * amplitudes)], history).torque_Nm
        except (ArithmeticError, LookupError, OverflowError, ValueError, MemoryError) as error:
            return f"cannot be evaluated ({type(error).__name__})"
    if not (np.isfinite(columns).all() and np.isfinite(teeth).all()):
        return "gives no finite angle"
    if columns.shape[1] != amplitudes:
        return f"has {amplitudes} amplitudes; it takes {columns.shape[1]}"
    return None


def channels_needed(cause: Cause, elements: Sequence[Element]) -> list[str]:
    """Channels without which the elements cannot be evaluated."""
    history = example_history(cycles=2)
    needed = []
    for channel in CHANNELS:
        lacking: dict[str, Any] = {channel: None}
        without = replace(history, **lacking)
        try:
            cause.angle_arcsec(elements, without)
        except ValueError:
            needed.append(channel)
    return needed


@cache
def _known(cause: Cause) -> tuple[frozenset[frozenset[str]], dict[str, frozenset[float]]]:
    """Sets of parameter names that a cause uses, and the values of those that no record changes."""
    prediction = Prediction(10.0, 0.3, 60.0, 10.0)
    records = (example_history(), example_history(7.0, 200.0, 9))
    tried = [cause.shapes(FitContext(prediction, h)) for h in records]
    apart = frozenset(frozenset(shape) for shape in cause.searched_apart)
    if not any(tried):
        return apart or frozenset({frozenset()}), {}
    unheld = (example_history(held=0), example_history(held=0, rested=12))
    others = [cause.shapes(FitContext(prediction, h)) for h in unheld]
    names = frozenset(frozenset(shape) for shapes in (*tried, *others) for shape in shapes)
    fixed = {}
    for name in set().union(*names) - set(cause.tunable):
        one, other = ({shape[name] for shape in shapes if name in shape} for shapes in tried)
        if one and one == other and all(float(v).is_integer() for v in one):
            fixed[name] = frozenset(one)
    return names | apart, fixed
