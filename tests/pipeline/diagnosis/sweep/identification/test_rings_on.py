"""A loop's misfit after the torque turns is no ringing; ringing beside a loop is."""

from __future__ import annotations

import numpy as np
import pytest
from histories import PREDICTION
from read_sweep import as_read, history_of, simulated, steps

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading, stops
from flexspline.pipeline.diagnosis.measurement.corners import corners_of
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep

LARGEST_Nm, NOISE_ARCSEC = 5.0, 0.3


def forms(history: History, added: np.ndarray, seed: int) -> set[str]:
    """Kinds of structure that are said to be unexplained, with these angles beside the simulated ones."""
    noise = np.random.default_rng(seed).normal(0, NOISE_ARCSEC, len(history))
    outcome, _ = diagnose_sweep(as_read(history, simulated(history) + added + noise), PREDICTION)
    return {
        form.kind
        for u in outcome.unexplained
        if isinstance(u.structure, tuple)
        for form in u.structure
    }


@pytest.mark.parametrize("law", ["square", "play"])
def test_friction_whose_loop_grows_does_not_ring(law: str) -> None:
    """By 0.6 to 1.4 of its mean in the record: square at its ends, or a single play operator."""
    history = history_of(steps(LARGEST_Nm, 75), 7)
    grown = 0.6 + 0.8 * np.arange(len(history)) / len(history)
    limit = 0.08 * LARGEST_Nm
    play = stops(history, history.torque_Nm, np.array([limit]), np.zeros(1))[:, 0] / limit
    side = direction_of_loading(history) if law == "square" else play
    assert "rings" not in forms(history, -5.5 * grown * side, 6)


def test_ringing_beside_friction_rings() -> None:
    """x'' + 2ζω x' + ω²x after each corner, a fifth of the friction's rms, by which it is not told."""
    history = history_of(steps(LARGEST_Nm, 75), 6)
    assert history.time_s is not None
    limit, omega, damping = 0.3, 2 * np.pi / 11, 0.08
    play = -5.0 / limit * stops(history, history.torque_Nm, np.array([limit]), np.zeros(1))[:, 0]
    rung = np.zeros(len(history))
    for corner in corners_of(history):
        t = np.maximum(history.time_s - corner.time_s, 0.0)
        rung += corner.change * np.exp(-damping * omega * t) * np.sin(omega * t)
    rung *= 0.2 * play.std() / rung.std()
    assert "rings" in forms(history, play + rung, 7)
