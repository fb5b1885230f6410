"""Noise of the rig: white and coloured angle noise, steps of the encoder, outliers, torque noise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from hidden.program import Program


@dataclass(frozen=True)
class Noise:
    """Attributes.

    white, coloured : standard deviations, arcsec.
    memory : correlation time in s, or in samples where `by_sample`.
    step : of the encoder, arcsec. outliers : share of the samples.
    torque : standard deviation of the torque reading, N·m.
    crossing : torque over which the gap is crossed, N·m; 0 is at once.
    """

    white: float
    coloured: float
    memory: float
    by_sample: bool
    step: float
    outliers: float
    torque: float
    crossing: float

    @property
    def said(self) -> str:
        clock = "samples" if self.by_sample else "s"
        return (
            f"noise {self.white:.2f}″ white, {self.coloured:.2f}″ over {self.memory:.2g} {clock}, step "
            f"{self.step:.2f}″, {100 * self.outliers:.1f} % outliers, torque {self.torque:.3g} N·m"
        )


@dataclass(frozen=True)
class Spread:
    """Second moments of the samples: independent variances and a first-order coloured part.

    keep[k] is the coloured part's correlation between samples k − 1 and k; keep[0] is 0.
    """

    independent: np.ndarray
    coloured: float
    keep: np.ndarray

    def covariance(self) -> np.ndarray:
        """Dense (n, n), arcsec²."""
        with np.errstate(divide="ignore"):
            log = np.log(self.keep)
        log[0] = 0
        run = np.cumsum(log)
        return np.diag(self.independent) + self.coloured**2 * np.exp(-np.abs(run[:, None] - run))

    def whitened(self, columns: np.ndarray) -> np.ndarray:
        """Innovations of every column (n, m) over their standard deviations: unit, uncorrelated noise."""
        state, p = np.zeros(columns.shape[1]), self.coloured**2
        out = np.empty_like(columns)
        for k in range(len(columns)):
            keep = self.keep[k]
            state = keep * state
            p = keep * keep * p + (1 - keep * keep) * self.coloured**2
            variance = p + self.independent[k]
            error = columns[k] - state
            out[k] = error / np.sqrt(variance)
            state = state + p / variance * error
            p -= p * p / variance
        return out


def draw_noise(windup: float, program: Program, rng: np.random.Generator) -> Noise:
    """0.2–3″ of angle noise (at most 4 % of the wind-up [arcsec]) and all the rest of it."""
    top = min(3.0, max(0.04 * windup, 0.25))
    sigma = float(np.exp(rng.uniform(np.log(0.2), np.log(top))))
    share = rng.uniform(0, 0.75) if rng.random() < 0.8 else 0.0
    by_sample = bool(rng.random() < 0.5)
    longest = program.quickest / 15
    spacing = float(np.median(np.diff(program.time[program.rows])))
    memory = np.exp(rng.uniform(np.log(0.5 * spacing), np.log(max(longest, spacing))))
    torque = program.peak * float(np.exp(rng.uniform(np.log(5e-4), np.log(5e-3))))
    return Noise(
        white=sigma * float(np.sqrt(1 - share**2)),
        coloured=sigma * share,
        memory=float(min(memory, longest) / (spacing if by_sample else 1.0)),
        by_sample=by_sample,
        step=float(min(np.exp(rng.uniform(np.log(0.05), 0)), 2.5 * sigma)),
        outliers=float(rng.choice([0.0, rng.uniform(0.001, 0.005)])),
        torque=torque,
        crossing=torque * float(rng.choice([0.0, rng.uniform(0.5, 2)], p=[0.6, 0.4])),
    )


def spread(noise: Noise, program: Program, slope: float, gap: float) -> Spread:
    """Of what is read, given the torque that is read: slope [arcsec/N·m], gap [arcsec].

    Torque noise counts through the slope; where it hides the torque's sign, the gap counts too.
    """
    torque = program.torque[program.rows]
    width = np.hypot(noise.torque, noise.crossing)
    p = ndtr(torque / width)
    independent = (
        noise.white**2 + noise.step**2 / 12 + (slope * noise.torque) ** 2 + gap**2 * p * (1 - p)
    )
    return Spread(independent, noise.coloured, _keep(noise, program))


def sample(noise: Noise, program: Program, rng: np.random.Generator) -> tuple[np.ndarray, ...]:
    """Angle noise without encoder steps [arcsec], where outliers are (bool), torque noise [N·m]."""
    n = len(program.rows)
    keep = _keep(noise, program)
    kick = rng.normal(size=n) * noise.coloured * np.sqrt(1 - keep**2)
    coloured = np.empty(n)
    x = 0.0
    for k in range(n):
        x = keep[k] * x + kick[k]
        coloured[k] = x
    angle = coloured + rng.normal(size=n) * noise.white
    out = np.zeros(n, bool)
    for k in rng.permutation(n)[: int(noise.outliers * n)]:
        if not out[max(k - 3, 0) : k + 4].any():  # isolated
            out[k] = True
    sigma = np.hypot(noise.white, noise.coloured)
    angle[out] += rng.uniform(8, 30, out.sum()) * rng.choice([-1, 1], out.sum()) * sigma
    return angle, out, rng.normal(size=n) * noise.torque


def read_by_encoder(angle: np.ndarray, step: float) -> np.ndarray:
    return np.round(angle / step) * step


def _keep(noise: Noise, program: Program) -> np.ndarray:
    step = (
        np.ones(len(program.rows))
        if noise.by_sample
        else np.diff(program.time[program.rows], prepend=0)
    )
    keep = np.exp(-step / noise.memory)
    keep[0] = 0.0
    return keep
