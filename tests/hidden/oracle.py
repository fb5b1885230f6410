"""What who knew the true model form would gain on the rows that a diagnosis held out."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from hidden.gear import Rig
from hidden.record import Unit

CROSSING = 4.0
"""Torque noise deviations about 0 where the gap is being crossed: left out of every error."""


@dataclass(frozen=True)
class Gain:
    """Root mean square errors on the held-out rows, arcsec."""

    before: float
    after: float
    floor: float

    @property
    def share(self) -> float:
        """(before² − after²)/(before² − floor²)."""
        return (self.before**2 - self.after**2) / (self.before**2 - self.floor**2)


def held_out_rows(gain: Mapping, rows: int, cycles: np.ndarray | None) -> np.ndarray | None:
    """True where the diagnosis held a row out; None where it does not say in a way one can follow.

    `rows` is how many the file has, `cycles` its column of that name.
    """
    if (listed := gain.get("held_out_rows")) is not None:
        out = np.zeros(rows, bool)
        out[np.asarray(listed, int)] = True
        return out
    found = re.fullmatch(r"cycles? ([\d, and]+)", str(gain.get("held_out", "")))
    if not found or cycles is None:
        return None
    return np.isin(cycles, [int(x) for x in re.findall(r"\d+", found[1])])


def oracle(units: list[Unit], rig: Rig, held: np.ndarray) -> Gain | None:
    """Fit zero, K and gap under the priors and each true effect's amount on the rest; then predict.

    `before` is the simulated line with the zero fitted on the rest; `floor` is the true noise.
    None where nothing is left to fit or to judge.
    """
    at, before, after, floor = 0, [], [], []
    for unit in units:
        n = len(unit.angle)
        test = held[at : at + n]
        at += n
        t = unit.torque
        clear = (np.abs(t) > CROSSING * unit.noise.torque) & ~unit.outlier
        half = np.sign(t) / 2
        simulated = rig.compliance * t + rig.gap * half
        columns = [np.ones(n), t, half, *unit.effects]
        design = np.stack([*columns, unit.angle - simulated], axis=1)
        train = clear & ~test
        if train.sum() < len(columns) + 2 or not (clear & test).any():
            continue
        unseen = replace(unit.spread, independent=np.where(train, unit.spread.independent, 1e12))
        white = unseen.whitened(design)[train]
        prior = np.zeros((2, white.shape[1]))
        prior[0, 1], prior[1, 2] = 1 / rig.compliance_std, 1 / rig.gap_std
        rows = np.concatenate([white, prior])
        fit = np.linalg.lstsq(rows[:, :-1], rows[:, -1], rcond=None)[0]
        seen = clear & test
        error = unit.angle - simulated
        before.append((error - error[train].mean())[seen])
        after.append((design[:, -1] - design[:, :-1] @ fit)[seen])
        floor.append(unit.spread.independent[seen] + unit.spread.coloured**2)
    if not before:
        return None
    b, a, f = (np.concatenate(x) for x in (before, after, floor))
    return Gain(
        float(np.sqrt(np.mean(b**2))), float(np.sqrt(np.mean(a**2))), float(np.sqrt(np.mean(f)))
    )
