"""What a diagnosis says; the same type for every kind of measurement."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

Verdict = Literal["consistent", "named", "ambiguous", "unknown", "insufficient"]


@dataclass(frozen=True)
class NamedCause:
    """A cause found; `alternatives` are ids that the data cannot tell from it."""

    id: str
    title: str
    probability: float
    alternatives: tuple[str, ...]
    magnitude: float
    magnitude_std: float
    unit: str
    evidence_nats: float
    """By how much the record is better explained with it than with the best set without."""
    rms_arcsec: float
    own_units: tuple[str, ...] = ()
    """Units under test that alone show it; empty: all do."""

    @property
    def is_surplus(self) -> bool:
        """Whether the simulation has too much of it, not too little: compliance that the gear lacks."""
        return self.id == "series_compliance" and self.magnitude < 0


def left_out(found: Sequence[NamedCause], said: Callable[[NamedCause], str]) -> str:
    """What the simulation leaves out and where it is too soft; `said` words one cause."""
    missing = [said(c) for c in found if not c.is_surplus]
    surplus = [said(c) for c in found if c.is_surplus]
    sentences = [f"The simulation leaves out: {'; '.join(missing)}."] if missing else []
    sentences += [f"The simulation is too soft: {'; '.join(surplus)}."] if surplus else []
    return " ".join(sentences)


@dataclass(frozen=True)
class Unexplained:
    """Structure that no named cause explains: in which channel, how large, how surely, what it is like."""

    channel: str
    rms: float
    p_value: float
    what: str


@dataclass(frozen=True)
class Gain:
    """Errors on held-out data, before and after, and the floor that noise sets; all in `unit`."""

    held_out: str
    rmse_before: float
    rmse_calibrated: float
    rmse_after: float
    noise_floor: float
    unit: str = "arcsec"
    held_out_rows: tuple[int, ...] = ()
    left: Mapping[str, np.ndarray] = field(default_factory=dict, compare=False, repr=False)
    """Measured less predicted angle of those rows: `before`, `calibrated`, `after`."""


@dataclass(frozen=True)
class NextMeasurement:
    """The measurement that tells the rivals apart best, and by how many units of noise."""

    vary: str
    why: str
    separation: float


@dataclass(frozen=True)
class DiagnosisOutcome:
    """The verdict and all that goes with it."""

    verdict: Verdict
    causes: tuple[NamedCause, ...]
    unexplained: tuple[Unexplained, ...]
    gain: Gain | None
    next_measurement: NextMeasurement | None
    summary: str
    """One or two sentences in plain words."""
    notes: tuple[str, ...] = field(default=())
