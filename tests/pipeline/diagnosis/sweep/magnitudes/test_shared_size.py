"""Friction and a lag that share one loop: each may have all of it, and is stated so."""

from __future__ import annotations

import numpy as np
from histories import PREDICTION
from read_sweep import as_read, simulated, steps

from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.magnitudes.shared_size import shared_std
from flexspline.pipeline.diagnosis.sweep.race.race import run_race

LOOP_ARCSEC, NOISE_ARCSEC, LARGEST_Nm, SLIPS_Nm = 5.0, 0.3, 12.0, 1.4
LAG_S, LAG_ARCSEC_PER_Nm = 8.0, 0.5
QUARTERS = (60, 20, 60, 20)
"""Rows, a second apart, from zero to the largest torque, of each cycle: two rates."""
FRICTION, RATE = "friction_hysteresis", "rate_dependence"


def test_a_rival_in_the_same_set_may_have_all() -> None:
    """A friction loop and a twist that lags, which two rates tell apart: friction alone has both."""
    cycles = [steps(LARGEST_Nm, quarter) for quarter in QUARTERS]
    torque = np.concatenate(cycles)
    number = np.repeat(np.arange(len(cycles)), [len(c) for c in cycles])
    n = len(torque)
    history = History(torque, np.zeros(n, int), number, 1.0 * np.arange(n))
    state, lagging, before, loop = 0.0, 0.0, 0.0, []
    for now in torque:
        state = float(np.clip(state + now - before, -SLIPS_Nm, SLIPS_Nm))
        before = now
        lagging += (now - lagging) / LAG_S
        loop.append(-LOOP_ARCSEC / 2 * state / SLIPS_Nm - LAG_ARCSEC_PER_Nm * (now - lagging))
    noise = np.random.default_rng(8).normal(0, NOISE_ARCSEC, n)
    angle = simulated(history) + np.array(loop) + noise
    identified = run_race(prepare(as_read(history, angle), PREDICTION)).identified
    magnitude = identified.size_doubt.magnitude
    assert {FRICTION, RATE} <= set(identified.named)
    assert shared_std(identified, FRICTION, magnitude, ()) == 0.0
    assert shared_std(identified, FRICTION, magnitude, ("creep",)) == 0.0
    apart = shared_std(identified, FRICTION, magnitude, (RATE,))
    # the lag's own loops are 2·b·τ·dT/dt wide: 1.6 arcsec at the slower rate and 4.8 at the quicker one
    slow, quick = (2 * LAG_ARCSEC_PER_Nm * LAG_S * LARGEST_Nm / quarter for quarter in QUARTERS[:2])
    assert slow < apart * np.sqrt(2) < quick
