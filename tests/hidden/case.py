"""A case: the files that a diagnosis gets, and the truth that it does not."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from hidden.gear import Rig
from hidden.record import Unit

KINDS = ("clean", "single", "pair", "triple", "foreign", "undecidable")


@dataclass(frozen=True)
class Case:
    """One hidden record.

    Attributes
    ----------
    csv, design : text of the two files. K_b, K_e : N·m/rad.
    again : the csv that the same gears and programme give with other noise; "" where no cause is hidden.
    truth : (id, magnitude in the unit of docs/contract.md), largest effect first; empty where none is named.
    standing : noise units beyond calibration and mimicry, one per hidden effect.
    decidable : all of them are at least 6.
    expected : causes that an `ambiguous` verdict must mention; tolerated : those that it may.
    seed : (run's seed, number) from which `cases.draw_case` makes the case again.
    foreign : which foreign effect is hidden, if one is. absorbed : share of it, in quadrature, that
        the best named cause could absorb.
    unsized : causes whose magnitude the record's positions do not fix, true law or not.
    said : the law, the programme, the noise in one line.
    """

    kind: str
    csv: str = field(repr=False)
    design: str = field(repr=False)
    K_b: float
    K_e: float
    truth: tuple[tuple[str, float], ...]
    severity: str
    standing: tuple[float, ...]
    decidable: bool
    expected: frozenset[str]
    tolerated: frozenset[str]
    seed: tuple[int, int]
    said: str
    units: tuple[Unit, ...] = field(repr=False)
    rig: Rig = field(repr=False)
    foreign: str = ""
    absorbed: float = 0.0
    unsized: frozenset[str] = frozenset()
    again: str = field(default="", repr=False)

    @property
    def rows(self) -> int:
        return sum(len(u.angle) for u in self.units)

    @property
    def file_cycles(self) -> np.ndarray | None:
        """The file's cycle column; None where it has none."""
        lines = [x.split(",") for x in self.csv.splitlines() if not x.startswith("#")]
        if "cycle" not in lines[0]:
            return None
        at = lines[0].index("cycle")
        return np.array([int(x[at]) for x in lines[1:]])

    @property
    def label(self) -> str:
        """What is hidden, for tables."""
        return " + ".join(name for name, _ in self.truth) or self.kind
