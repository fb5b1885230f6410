"""Nuisance terms: flexible functions of each channel, which have no name.

They stand in the race beside the named causes, so that an effect that no cause explains is not given
the name of the cause that mimics it best.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.causes.sensor_drift import DRIFT
from flexspline.pipeline.diagnosis.causes.stiffness_hardening import HARDENING
from flexspline.pipeline.diagnosis.measurement.torque_jitter import less_jitter
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.local_bend import CurveBend
from flexspline.pipeline.diagnosis.sweep.local_bump import Bump
from flexspline.pipeline.diagnosis.sweep.local_step import CurveStep
from flexspline.pipeline.diagnosis.sweep.nuisance.channel_nuisance import (
    changing_friction,
    changing_gain,
    changing_stiffness,
    over_cycle,
    over_position,
    over_temperature,
    over_time,
    over_turns,
    over_unit,
    step_from,
    waves_and_steps,
    zeros_apart,
)
from flexspline.pipeline.diagnosis.sweep.nuisance.lagged_torque import lagging_torque
from flexspline.pipeline.diagnosis.sweep.nuisance.rig_nuisance import giving_way, ringing
from flexspline.pipeline.diagnosis.sweep.nuisance.torque_nuisance import (
    Made,
    bends_of,
    bump_of,
    even_curve,
    leading,
    over_angle,
    over_direction,
    over_torque,
    softening,
    step_of,
)
from flexspline.pipeline.diagnosis.sweep.row_selection import settling

NUISANCE_SPREAD, SLIGHT_SPREAD = 0.15, 0.015
"""Prior sizes of an amplitude, as shares of the predicted angle. Of many zeros each costs the log of its
prior over what is known of it: at the usual size twenty would hide a scatter of a third of the noise."""
NEW_SHARE = 0.25
"""Least part of a column beside torque and gap, over its size. A column with less is not a nuisance term.
Judgement."""
LEAST_COLUMN = 1e-9
"""Rms of a column about its mean, in its own unit (1, N·m, °C): below, it is constant but for rounding."""


@dataclass(frozen=True)
class NuisanceTerm:
    """A flexible term: which channel it lives in, its form, and its columns (n, k)."""

    channel: str
    form: UnnamedForm
    columns: np.ndarray
    spread: float
    """Prior size of an amplitude, as a share of the predicted angle."""
    positive: bool = False
    against: frozenset[str] = frozenset()
    """Causes beside which it does not stand: it is their opposite, or all that they are and more, and the two
    would cancel."""
    apart: bool = False
    """Whether it shares its channel's prior with such terms alone: it is like none of the others."""


@dataclass(frozen=True)
class _NuisanceKind:
    """How nuisance terms of one kind are made, and what the race must know of them.

    `less`: of what the columns come less, as calibration and causes can be that; None: as they are.
    """

    make: Callable[[FitContext], Made]
    less: Callable[[FitContext], np.ndarray] | None = None
    positive: bool = False
    against: frozenset[str] = frozenset()
    spread: float = NUISANCE_SPREAD
    apart: bool = False


def nuisance_terms(
    rig: FitContext,
    step: int | None = None,
    bumps: Sequence[Bump | CurveStep] = (),
    bends: Sequence[Sequence[CurveBend]] = (),
) -> list[NuisanceTerm]:
    """All flexible terms that a rig's record has the channels for.

    `step` : the row from which a jump of the zero is likeliest. `bumps` : those of the curve, and its steps.
    `bends` : its bends, each with those that it is doubted by.
    Columns have unit rms in the rows that count.
    """
    kinds: tuple[_NuisanceKind, ...] = NUISANCE_KINDS
    if step is not None:
        kinds = (*kinds, _NuisanceKind(partial(step_from, row=step), less=_of_lags))
    for bump in bumps:
        make = (
            partial(bump_of, bump=bump) if isinstance(bump, Bump) else partial(step_of, step=bump)
        )
        kinds = (*kinds, _NuisanceKind(make))
    for some in bends:
        make = partial(bends_of, bends=some)
        of_both = bool(some) and not some[0].side
        kinds = (*kinds, replace(SOFTENING_KIND, make=make) if of_both else _NuisanceKind(make))
    counted = ~settling(rig.history)
    taken = {kind.less: kind.less(rig) for kind in kinds if kind.less is not None}
    share = counted / counted.sum()
    onto = {less: _projection(columns, share) for less, columns in taken.items()}
    terms = []
    for kind in kinds:
        for channel, form, columns in kind.make(rig):
            rest = columns
            if kind.less is not None:
                rest = columns - taken[kind.less] @ (onto[kind.less] @ columns)
            was = np.sqrt(np.maximum(share @ columns**2 - (share @ columns) ** 2, 0.0))
            rms = np.sqrt(share @ rest**2)
            good = rms > NEW_SHARE * np.maximum(was, LEAST_COLUMN)
            if good.any():
                terms.append(
                    NuisanceTerm(
                        channel,
                        form,
                        rest[:, good] / rms[good],
                        kind.spread,
                        kind.positive,
                        kind.against,
                        kind.apart,
                    )
                )
    return terms


def _projection(columns: np.ndarray, share: np.ndarray) -> np.ndarray:
    """(k, n) coefficients of columns (n, k) that fit a function best, each row by its share of the weight.

    By normal equations, which need no decomposition of a million rows.
    """
    weighted = (columns * share[:, None]).T
    inverse: np.ndarray = np.linalg.pinv(weighted @ columns) @ weighted
    return inverse


def _of_torque(rig: FitContext) -> np.ndarray:
    """(n, k) zero of each unit, torque without its noise, side of the gap."""
    h = rig.history
    zeros = h.unit[:, None] == np.arange(len(h.unit_slices))
    return np.column_stack([zeros, less_jitter(h).torque_Nm, h.sign])


def _of_lags(rig: FitContext) -> np.ndarray:
    """(n, k) zero of each unit, torque, side of the gap, and torque through two lags.

    A wave in time with the torque's own period is the torque without its noise, and would win by that; a
    wave in quadrature with it, beside a lag, is that too. So would a step where a unit's rows begin to count
    be: beside the unit's zero nothing is left of it but the lags that it is less.
    """
    h = rig.history
    zeros = h.unit[:, None] == np.arange(len(h.unit_slices))
    return np.column_stack([zeros, h.torque_Nm, h.sign, lagging_torque(h)])


SOFTENING_KIND = _NuisanceKind(softening, positive=True, against=frozenset({HARDENING}))
NUISANCE_KINDS = (
    _NuisanceKind(over_torque, less=_of_torque),
    _NuisanceKind(even_curve),
    SOFTENING_KIND,
    _NuisanceKind(over_angle, less=_of_torque),
    _NuisanceKind(over_direction, less=_of_lags),
    _NuisanceKind(leading, positive=True, against=frozenset({FRICTION, RATE})),
    _NuisanceKind(over_time, less=_of_lags, against=frozenset({DRIFT})),
    _NuisanceKind(changing_stiffness),
    _NuisanceKind(changing_gain),
    _NuisanceKind(waves_and_steps, less=_of_lags),
    _NuisanceKind(over_cycle),
    _NuisanceKind(over_temperature),
    _NuisanceKind(over_position),
    _NuisanceKind(over_turns),
    _NuisanceKind(changing_friction, against=frozenset({FRICTION}), apart=True),
    _NuisanceKind(zeros_apart, spread=SLIGHT_SPREAD),
    _NuisanceKind(over_unit),
    _NuisanceKind(giving_way, positive=True),
    _NuisanceKind(ringing, less=_of_lags),
)
