"""How far a hidden effect stands out: noise units beyond calibration and what others could absorb."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from hidden.fit import left_over
from hidden.gear import Rig
from hidden.mimicry import families
from hidden.record import Unit

CALIBRATED = ("series_compliance", "clearance_offset")
"""Causes whose magnitude is 'all of it': what was drawn within the uncertainty counts too."""


@dataclass(frozen=True)
class Standing:
    """The hidden effects and every family in whitened noise units, calibration projected out.

    Attributes
    ----------
    effects : (m, k), one column per hidden effect. families : cause → (m, columns).
    The m rows are a rotation of the samples': lengths and angles are the record's own.
    """

    effects: np.ndarray
    families: dict[str, np.ndarray]

    def beyond(self, k: int, causes: tuple[str, ...], also: tuple[int, ...] = ()) -> float:
        """Length of effect k that the causes together and the effects `also` cannot absorb."""
        target = self.effects[:, k]
        parts = [self.families[c] for c in causes if c in self.families]
        free = [self.effects[:, [j]] for j in also] + [-self.effects[:, [j]] for j in also]
        if not parts and not free:
            return float(np.linalg.norm(target))
        return left_over(np.concatenate([*parts, *free], axis=1), target)

    def beyond_one(self, k: int, cause: str) -> float:
        """Length of effect k that no one column of the cause absorbs: a mimic of a single shape."""
        columns, target = self.families[cause], self.effects[:, k]
        size = np.linalg.norm(columns, axis=0)
        along = np.maximum(target @ columns / np.where(size > 1e-9, size, np.inf), 0).max()
        return float(np.sqrt(max(target @ target - along**2, 0.0)))

    def single(self, k: int, own: str) -> tuple[float, str]:
        """Least length left by any one cause but its own, and which one leaves it."""
        left = {c: self.beyond(k, (c,)) for c in self.families if c != own}
        best = min(left, key=left.get)
        return min(left[best], self.beyond(k, ())), best

    def in_company(self, k: int, causes: list[str]) -> float:
        """Length of effect k, of `causes[k]`, left by the others' families and that of an absent cause.

        The other hidden effects are free as well: their own laws may be in no family.
        """
        others = tuple(c for j, c in enumerate(causes) if j != k)
        also = tuple(j for j in range(len(causes)) if j != k)
        absent = [c for c in self.families if c not in causes]
        return min(self.beyond(k, (*others, c), also) for c in absent)

    def of_two(self, k: int) -> float:
        """Length left by the best two causes."""
        return min(self.beyond(k, pair) for pair in combinations(self.families, 2))


def standing(units: list[Unit], rig: Rig, causes: tuple[str, ...]) -> Standing:
    """Whiten every unit by its true noise, free its zero, hold K and gap by the design's priors."""
    blocks = []
    names: dict[str, int] = {}
    for unit in units:
        p, t = unit.program, unit.true_torque
        span = families(p, unit.gear)
        names = {c: m.shape[1] for c, m in span.items()}
        half = np.sign(t) / 2
        effects = [
            e + _drawn(cause, unit, rig, t, half)
            for cause, e in zip(causes, unit.effects, strict=True)
        ]
        calibration = np.stack([np.ones_like(t), t, half], axis=1)
        raw = np.concatenate([calibration, *span.values(), np.stack(effects, axis=1)], axis=1)
        white = unit.spread.whitened(raw)
        prior = np.zeros((2, white.shape[1]))
        prior[0, 1], prior[1, 2] = 1 / rig.compliance_std, 1 / rig.gap_std
        free = np.concatenate([white, prior])
        q, _ = np.linalg.qr(free[:, :3])
        rest = free[:, 3:]
        blocks.append(rest - q @ (q.T @ rest))
    short = np.linalg.qr(np.concatenate(blocks), mode="r")
    out, at = {}, 0
    for cause, width in names.items():
        out[cause] = short[:, at : at + width]
        at += width
    return Standing(short[:, at:], out)


def _drawn(cause: str, unit: Unit, rig: Rig, torque: np.ndarray, half: np.ndarray) -> np.ndarray:
    if cause == "series_compliance":
        return (unit.gear.compliance - rig.compliance) * torque
    if cause == "clearance_offset":
        return (unit.gear.gap - rig.gap) * half
    return np.zeros_like(torque)
