"""Tests of the best model's residual in every channel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc

from flexspline.pipeline.diagnosis.causes.operators import direction_of_loading, steadied
from flexspline.pipeline.diagnosis.measurement.torque_noise import torque_noise_Nm
from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import GaussianEvidence
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.residual.multiple_tests import p_value_of_best

RANK_SHARE = 1e-3
"""Share of the largest singular value. Smaller ones belong to bins that the model's terms can reproduce,
which do not count."""
CHANNEL_BINS = 12
"""Of a channel: 8 or 20 change no verdict of 12 made-up records (`tests/hidden`, seed 77,
every third of 34)."""
FEWEST_PER_BIN = 5
"""Usual least count of a bin in a χ² test (Cochran, Biometrics 10, 417 (1954))."""
APART_TORQUES = 4.0
"""Largest torques by which the two directions of loading are moved apart: each spans two."""
STEADY_SIGMAS = 3.0
"""Standard deviations of the torque's noise within which bins of torque do not follow the reading.
Judgement."""
STRUCTURE_P_VALUE = 1e-4
"""p-value below which a channel's structure is said; eight channels are tested, so that noise alone has one
said in a record of 1200. 1e-3 changes no verdict of those 12 records, nothing held out."""
UNKNOWN_P_VALUE = 1e-8
"""p-value of a channel's structure that, with nothing named, makes the verdict `unknown`. The square of the
other, by judgement: it takes the noise for known, which is estimated. 1e-6 or 1e-10 change no verdict of
those 12 either."""


@dataclass(frozen=True)
class ChannelTest:
    """Structure of the residual in one channel: its rms [arcsec], and its p-value."""

    channel: str
    rms_arcsec: float
    p_value: float


def channel_tests(prepared: PreparedSweep, fit: SweepFit) -> list[ChannelTest]:
    """Test what a solution leaves against each channel.

    The channel's bins, less what the model's own terms can be, explain a χ² with as many degrees of
    freedom as they have where nothing is left. All is whitened, so coloured noise does not pass for
    structure.
    """
    residual = Residual.of(prepared, fit)
    tests = [
        residual.tested(channel, codes)
        for channel, values in _channels(prepared).items()
        if (codes := _bins(values)).max() > 0
    ]
    return [*tests, _wave(prepared, residual.left)]


@dataclass(frozen=True)
class Residual:
    """What a solution leaves of a sweep, whitened.

    Attributes
    ----------
    model (r, k) : orthonormal, what its terms can be. left (r,) : what they leave.
    """

    prepared: PreparedSweep
    evidence: GaussianEvidence
    model: np.ndarray
    left: np.ndarray

    @classmethod
    def of(cls, prepared: PreparedSweep, fit: SweepFit) -> Residual:
        evidence = fit.evidence
        chosen = [evidence.x[:, evidence.terms[i].at] for i in fit.posterior.terms]
        model, _ = np.linalg.qr(np.hstack([evidence.base, *chosen]))
        return cls(prepared, evidence, model, evidence.y - model @ (model.T @ evidence.y))

    def tested(self, channel: str, codes: np.ndarray) -> ChannelTest:
        """Its structure in bins (n,), numbered from 0."""
        bins = self.evidence.whitened((codes[:, None] == np.arange(codes.max() + 1)).astype(float))
        bins -= self.model @ (self.model.T @ bins)
        basis, size, _ = np.linalg.svd(bins, full_matrices=False)
        own = basis[:, size > RANK_SHARE * size.max()]
        statistic = float(((own.T @ self.left) ** 2).sum())
        freedom = own.shape[1]
        share = max(0.0, statistic - freedom) / max(1.0, float(self.left @ self.left))
        rms = float(np.sqrt(share)) * self.prepared.noise.std_arcsec
        return ChannelTest(channel, rms, float(chdtrc(freedom, statistic)))


def _wave(prepared: PreparedSweep, left: np.ndarray) -> ChannelTest:
    """The strongest wave in time of any period: too fast for the nuisance terms, or too slow.

    In white noise each frequency's power is exponential with mean 1, and there are about as many
    independent frequencies as half the rows. Source: Scargle, Astrophysical Journal 263, 835 (1982).
    """
    history = prepared.rig.history
    assert history.time_s is not None
    t = history.time_s[prepared.kept].astype(float)
    block = len(t) // len(left)
    t = t[: len(left) * block].reshape(-1, block).mean(axis=1)
    for rows in _units(history.unit[prepared.kept][: len(left) * block : block]):
        t[rows] -= t[rows[0]]
    length = np.ptp(t)
    if length <= 0:
        return ChannelTest("time_s", 0.0, 1.0)
    count = max(8, len(left) // 2)
    power = _periodogram(t, (left - left.mean()) / left.std(), np.pi / length, 2 * count)
    top = float(power.max())
    # exp(−700) = 1e-304 is near the least that a double holds
    p_value = p_value_of_best(float(np.exp(-min(top, 700.0))), count, independent=True)
    share = 2 * top / len(left)
    return ChannelTest(
        "time_s", float(np.sqrt(min(share, 1.0))) * prepared.noise.std_arcsec, p_value
    )


def _periodogram(t: np.ndarray, y: np.ndarray, step: float, count: int) -> np.ndarray:
    """(count,) power |Σ y e^(−iωt)|²/n at ω = step, 2·step, …; t (n,) need not be even."""
    turn = np.exp(-1j * step * t)
    wave, power = np.ones(len(t), complex), np.empty(count)
    for k in range(count):
        wave = wave * turn
        power[k] = abs(y @ wave) ** 2
    return power / len(t)


def _units(unit: np.ndarray) -> list[np.ndarray]:
    return [np.flatnonzero(unit == u) for u in np.unique(unit)]


def _channels(prepared: PreparedSweep) -> dict[str, np.ndarray]:
    h = prepared.rig.history
    side = direction_of_loading(h)
    # bins of the raw reading would sort a hold's rows by the torque's noise, which the angle shows
    torque = steadied(h, STEADY_SIGMAS * torque_noise_Nm(h))
    channels: dict[str, np.ndarray] = {
        "torque_Nm": torque,
        "direction": torque + APART_TORQUES * prepared.rig.largest_Nm * side,
        "cycle": h.cycle.astype(float),
    }
    if prepared.sweep.history.time_s is not None and h.time_s is not None:
        channels["time_s"] = h.time_s
    if h.temperature_C is not None:
        channels["temperature_C"] = h.temperature_C
    if h.input_angle_deg is not None:
        channels["input_angle_deg"] = h.input_angle_deg
    if len(prepared.sweep.units) > 1:
        channels["unit"] = h.unit.astype(float)
    return channels


def _bins(values: np.ndarray) -> np.ndarray:
    """(n,) bin of each value: levels where they are few, else equal counts."""
    levels = np.unique(values)
    if len(levels) <= CHANNEL_BINS:
        return np.searchsorted(levels, values)
    count = int(min(CHANNEL_BINS, max(2, len(values) // FEWEST_PER_BIN)))
    edges = np.unique(np.quantile(values, np.linspace(0, 1, count + 1)[1:-1]))
    return np.searchsorted(edges, values, side="right")
