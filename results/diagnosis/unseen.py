"""Effects that a record cannot show, whatever the gear does: one line each."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading
from flexspline.pipeline.diagnosis.causes.rate_dependence import FASTER, RATE
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.sweep.identification.rate_independence import (
    at_one_rate_on_ramps,
)
from flexspline.results.diagnosis.channels import channel_words

LEAST_OTHER_WAY = 0.05
"""Of the rows: fewer on one side, or in one direction, are an approach or a turn."""
WITHOUT = {
    "time_s": "friction cannot be distinguished from rate dependence, nor drift from wear",
    "temperature_C": "a gap that changes with temperature looks like wear or drift",
    "input_angle_deg": "a zero offset or a stiffness that changes with this angle looks like scatter between "
    "cycles",
}
"""What a channel that was not recorded leaves open."""


def unseen_notes(history: History, band_Nm: float, causes: Iterable[NamedCause] = ()) -> list[str]:
    """Sides, directions, rates and channels that the record lacks; `band_Nm` is the gap's crossing."""
    notes = []
    torque = history.torque_Nm
    if min(np.mean(torque > band_Nm), np.mean(torque < -band_Nm)) < LEAST_OTHER_WAY:
        notes.append(
            "torque acts in one direction only: the record does not show the gap, a shifted torque reading, "
            "or a stiffness that differs between directions; also sweep to −T"
        )
    direction = direction_of_loading(history)
    if min(np.mean(direction > 0), np.mean(direction < 0)) < LEAST_OTHER_WAY:
        notes.append(
            "torque changes in one direction only: the record does not show friction; also sweep back to zero"
        )
    elif history.time_s is not None and at_one_rate_on_ramps(history):
        distinguished = any(c.id == FRICTION and RATE not in c.alternatives for c in causes)
        lag = (
            "only the form of the loop distinguishes friction from a lag"
            if distinguished
            else "a lag gives the same loop as friction"
        )
        notes.append(
            f"all cycles have the same rate: {lag}; repeat one cycle at 1/{FASTER:g} of the rate"
        )
    notes += [
        f"{channel_words(channel)} was not recorded: {leaves_open}"
        for channel, leaves_open in WITHOUT.items()
        if getattr(history, channel) is None
    ]
    return notes
