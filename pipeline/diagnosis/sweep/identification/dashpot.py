"""Whether one viscous element of a low power explains what friction and a lag explain together.

The lag of `causes/rate_dependence.py` is linear, and its power is taken afterwards. A spring beside a dashpot
whose torque goes with a power below 1 of the speed lags by another course: after a turn it starts at once,
and comes to rest late. In the race that is a lag with a little friction.
"""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.operators import steadied
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.decision import RIVAL_EVIDENCE
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.ramps import ramp_rate, ramp_s
from flexspline.pipeline.diagnosis.measurement.torque_jitter import less_jitter
from flexspline.pipeline.diagnosis.measurement.torque_noise import deadband_Nm
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Search
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import gaussian_evidence
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification

POWERS = (0.35, 1.0)
"""Powers of the speed that are tried, from and to. Greases become thinner with speed by powers of a half and
more (Carreau's law)."""
TIMES = (0.01, 0.5)
"""Time over a ramp's, from and to: how long the lag would take to build up at its initial rate. Judgement."""
TRIED_NUMBERS, ZOOMS = (6, 9), 3
"""Powers and times tried at once, evenly and by equal factors; and how often about the best of them, a third
as far apart each time."""
NEWTON_STEPS = 4
"""From the row before; the residual is then below 1e-6 of the lag."""


def dashpot_explains(identified: Identification) -> bool:
    """Whether a set with one such element in place of friction and lag is not clearly worse."""
    evidence, best = identified.search.evidence, identified.best
    old = evidence.columns
    history = old.rig.history
    loops = [i for i in best.terms if evidence.terms[i].owner in (FRICTION, RATE)]
    lag = next((i for i in loops if evidence.terms[i].owner == RATE), None)
    if lag is None or old.ahead is not None or ramp_s(history) == 0:
        return False
    others = [i for i in best.terms if i not in loops]
    powers, times = (
        np.linspace(*POWERS, TRIED_NUMBERS[0]),
        np.geomspace(*TIMES, TRIED_NUMBERS[1]),
    )
    apart, factor = powers[1] - powers[0], times[1] / times[0]
    for _ in range(1 + ZOOMS):
        scores = _scores(identified, others, lag, powers, times)
        if best.score - scores.max() < RIVAL_EVIDENCE:
            return True
        at = np.unravel_index(scores.argmax(), scores.shape)
        apart, factor = apart / 3, factor ** (1 / 3)
        powers = np.minimum(powers[at[0]] + apart * np.arange(-2, 3), POWERS[1])
        times = times[at[1]] * factor ** np.arange(-2.0, 3.0)
    return False


def _scores(
    identified: Identification,
    others: list[int],
    lag: int,
    powers: np.ndarray,
    times: np.ndarray,
) -> np.ndarray:
    """(p, t) score of the other terms beside one element of each power and time, with term `lag`'s prior."""
    evidence = identified.search.evidence
    old, kept = evidence.columns, evidence.kept
    like = evidence.terms[lag]
    carried = dashpot_torque_Nm(old.rig.history, powers, times)
    sizes = [rms(column[kept]) for column in (old.all[:, like.at], *carried.T)]
    beside_these = [evidence.terms[i] for i in others]
    columns = old.with_terms(
        [*beside_these, *[like] * carried.shape[1]],
        [*(old.all[:, t.at] for t in beside_these), -carried / sizes[1:] * sizes[0]],
    )
    search = Search(gaussian_evidence(columns, evidence.target, kept, evidence.noise))
    beside = range(len(others))
    alone = [search.candidate([*beside, k]).score for k in range(len(others), len(columns.terms))]
    return np.array(alone).reshape(len(powers), len(times))


def dashpot_torque_Nm(history: History, powers: np.ndarray, times: np.ndarray) -> np.ndarray:
    """(n, p·t) torque e [N·m] that dashpots carry: de/dt = dT/dt − r·|e/E|^(1/p)·sign e, E = r·τ.

    A spring in parallel with a dashpot, T = k·q + η·|dq/dt|^p: e is the dashpot's share, r the ramps' rate of
    torque, at which it is E. Implicit from row to row. `powers` (p,), and `times` (t,) τ as shares of a ramp.
    """
    assert history.time_s is not None
    power, time = (values.ravel() for values in np.meshgrid(powers, times, indexing="ij"))
    rate = ramp_rate(history)
    most = rate * time * ramp_s(history)
    torque = steadied(less_jitter(history), deadband_Nm(history))
    out = np.empty((len(history), len(power)))
    for rows in history.unit_slices:
        steps = np.diff(history.time_s[rows], prepend=history.time_s[rows[0]])
        moves = np.diff(torque[rows], prepend=torque[rows[0]])
        carried = np.zeros(len(power))
        for row, step, move in zip(rows, steps, moves, strict=True):
            carried = _after(carried, move, rate * step, most, 1 / power)
            out[row] = carried
    return out


def _after(
    carried: np.ndarray, move: float, flow: float, most: np.ndarray, root: np.ndarray
) -> np.ndarray:
    """(m,) e of e − e₀ − move + flow·|e/E|^root·sign e = 0 by Newton's method: the left side rises with e."""
    driven = carried + move
    carried_after = np.clip(
        driven, -np.maximum(np.abs(carried), most), np.maximum(np.abs(carried), most)
    )
    for _ in range(NEWTON_STEPS):
        share = np.abs(carried_after) / most
        slope = 1 + flow * root / most * share ** (root - 1)
        carried_after = (
            carried_after
            - (carried_after - driven + flow * np.sign(carried_after) * share**root) / slope
        )
    return carried_after
