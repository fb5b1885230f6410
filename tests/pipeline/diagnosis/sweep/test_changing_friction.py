"""Friction that runs in, or follows the temperature, is told by its channel, and as no lock that slips."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from histories import PREDICTION
from read_sweep import as_read, history_of, simulated, steps

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.results.diagnosis.advice import why

NOISE_ARCSEC, LARGEST_Nm, SLIPS_Nm, CYCLES = 0.3, 12.0, 0.5, 8


def loop(history: History, width_arcsec: np.ndarray) -> np.ndarray:
    """(n,) angle of one slider behind the gap, by the width (n,) of its loop."""
    state, before, held = 0.0, 0.0, []
    for torque in history.torque_Nm:
        state = float(np.clip(state + torque - before, -SLIPS_Nm, SLIPS_Nm))
        before = torque
        held.append(state / SLIPS_Nm)
    return -width_arcsec / 2 * np.array(held)


@pytest.mark.parametrize("channel", ["cycle", "temperature_C"])
def test_a_loop_that_changes_is_told_by_what_changes_it(channel: str) -> None:
    history = history_of(steps(LARGEST_Nm, 40), CYCLES)
    if channel == "cycle":  # runs in, from 14 to 4 arcsec
        width = 4 + 10 * np.exp(-history.cycle / 1.5)
    else:  # in mixed order, so that no count of cycles does it
        warm = 20 + 5.0 * (3 * np.arange(CYCLES) % 8)
        history = replace(history, temperature_C=warm[history.cycle])
        width = 14 * 0.5 ** ((warm[history.cycle] - 20) / 15)
    angle = simulated(history) + loop(history, width)
    noise = np.random.default_rng(6).normal(0, NOISE_ARCSEC, len(angle))
    outcome, _ = diagnose_sweep(as_read(history, angle + noise), PREDICTION)
    assert outcome.verdict == "unknown"
    # friction in the mean may be named beside it
    assert {c.id for c in outcome.causes} <= {"friction_hysteresis"}
    first = outcome.unexplained[0]
    assert first.channel == channel
    assert isinstance(first.structure, tuple)
    assert {form.kind for form in first.structure} == {"changing_loop"}
    assert "gives_way" not in str(outcome.unexplained)
    after = outcome.next_measurement
    assert after is not None
    assert after.vary == channel
    assert "friction loop whose width changes" in why(after, "sweep")
