"""Nuisance terms: flexible functions of each channel, which have no name.

They stand in the race beside the named causes, so that an effect that no cause explains is not given
the name of the cause that mimics it best.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.causes.cause import Rig
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.sweep.channel_nuisance import (
    changing_stiffness,
    over_cycle,
    over_position,
    over_temperature,
    over_time,
    over_unit,
    waves_and_steps,
)
from flexspline.pipeline.diagnosis.sweep.lagging import lagging_torque
from flexspline.pipeline.diagnosis.sweep.rig_nuisance import giving_way, ringing
from flexspline.pipeline.diagnosis.sweep.torque_nuisance import (
    Made,
    leading,
    over_angle,
    over_direction,
    over_torque,
    softening,
)

NEW_SHARE = 0.25
"""Of a column's own size: one of which less is new beside torque and gap is no nuisance term."""


@dataclass(frozen=True)
class NuisanceTerm:
    """A flexible term: which channel it lives in, what it is, and its columns (n, k)."""

    channel: str
    what: str
    columns: np.ndarray
    positive: bool = False
    against: frozenset[str] = frozenset()
    """Causes beside which it does not stand: it is their opposite, or all that they are and more, and the two
    would cancel."""


@dataclass(frozen=True)
class _Kind:
    """How nuisance terms of one kind are made, and what the race must know of them.

    `less_linear`: whether the columns come less what zero, compliance and gap can be.
    """

    make: Callable[[Rig], Made]
    less_linear: bool = False
    positive: bool = False
    against: frozenset[str] = frozenset()


KINDS = (
    _Kind(over_torque, less_linear=True),
    _Kind(softening, positive=True, against=frozenset({"stiffness_hardening"})),
    _Kind(over_angle, less_linear=True),
    _Kind(over_direction, less_linear=True),
    _Kind(leading, positive=True, against=frozenset({FRICTION, "rate_dependence"})),
    _Kind(over_time, less_linear=True, against=frozenset({"sensor_drift"})),
    _Kind(changing_stiffness),
    _Kind(waves_and_steps, less_linear=True),
    _Kind(over_cycle),
    _Kind(over_temperature),
    _Kind(over_position),
    _Kind(over_unit),
    _Kind(giving_way),
    _Kind(ringing, less_linear=True),
)


def nuisance_terms(rig: Rig) -> list[NuisanceTerm]:
    """All flexible terms that a rig's record has the channels for; columns have unit rms."""
    linear = _linear(rig)
    inverse = np.linalg.pinv(linear)
    found = []
    for kind in KINDS:
        for channel, what, columns in kind.make(rig):
            rest = columns - linear @ (inverse @ columns) if kind.less_linear else columns
            was = np.sqrt(((columns - columns.mean(axis=0)) ** 2).mean(axis=0))
            rms = np.sqrt((rest**2).mean(axis=0))
            good = rms > NEW_SHARE * np.maximum(was, 1e-9)
            if good.any():
                found.append(
                    NuisanceTerm(
                        channel, what, rest[:, good] / rms[good], kind.positive, kind.against
                    )
                )
    return found


def _linear(rig: Rig) -> np.ndarray:
    """(n, k) zero, torque, side of the gap, and torque through two lags.

    A wave in time with the torque's own period is the torque without its noise, and would win by that;
    a wave in quadrature with it, beside a lag, is that too.
    """
    h = rig.history
    return np.column_stack([np.ones(len(h)), h.torque_Nm, h.sign, lagging_torque(h)])
