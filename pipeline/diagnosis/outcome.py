"""Result of a diagnosis; the same type for every kind of measurement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from typing import Literal

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.left_out import LeftOut
from flexspline.pipeline.diagnosis.shortage import Shortage
from flexspline.pipeline.diagnosis.structure import BrokenLimit, Structure

Verdict = Literal["consistent", "named", "ambiguous", "unknown", "insufficient"]
ScaleError = Literal["angle", "unit"]
"""Of a reading: the angle by any factor, or torque or angle in another unit."""

SIZE_KNOWN = 2.0
"""Standard deviations from no effect. A smaller size is compatible with none."""


@dataclass(frozen=True)
class NamedCause:
    """A cause found; `alternatives` are ids that the data cannot tell from it."""

    id: str
    probability: float
    alternatives: tuple[str, ...]
    magnitude: float
    magnitude_std: float
    unit: str
    evidence_nats: float
    """Evidence of the best set with it over the best set without it."""
    rms_arcsec: float
    own_units: tuple[str, ...] = ()
    """Units under test that alone show it; empty: all do."""
    ahead_Nm: float = 0.0
    """Of friction: the torque that it takes ahead of the teeth, so that gap and elasticity see the rest."""
    ahead_std_Nm: float = 0.0
    """Its standard deviation, the doubt of the law by which it slides included."""
    widest_arcsec: float | None = None
    """Of friction: the closed loop's width where it is widest; the magnitude is that at T = 0."""
    or_temperature: bool = False
    """Of a drift: the zero may as well follow the temperature, which no cause has the name of."""
    or_scale: ScaleError | None = None
    """Of an elastic part: the scale error of a reading that explains the record as well."""
    none: float | None = None
    """The magnitude of no effect, of causes that only specimens show; of others their class states it."""

    @property
    def deviations(self) -> float:
        """How many standard deviations the size is away from no effect."""
        off = abs(self.magnitude - none_of(self))
        return off / self.magnitude_std if self.magnitude_std > 0 else inf

    @property
    def is_surplus(self) -> bool:
        """Whether the simulation has too much of it: compliance that the gear does not have."""
        return self.id == SERIES and self.magnitude < 0

    @property
    def stiffer_pct(self) -> tuple[float, float]:
        """Of a surplus: by how much the gear is stiffer than simulated, and the standard deviation [%]."""
        left = 1 + self.magnitude / 100
        return 100 * (1 / left - 1), self.magnitude_std / left**2


def none_of(cause: NamedCause) -> float:
    """The magnitude that no effect has."""
    known = known_causes().get(cause.id)
    if cause.none is not None or known is None:
        return cause.none or 0.0
    return known.none


@dataclass(frozen=True)
class Unexplained:
    """Structure that no named cause explains: in which channel, how large, how surely, what it is like.

    `rms` in `unit`.
    """

    channel: str
    rms: float
    p_value: float
    structure: Structure
    unit: str = "arcsec"

    @property
    def limit(self) -> bool:
        """Whether it is a physical limit that the best explanation breaks."""
        return isinstance(self.structure, BrokenLimit)


@dataclass(frozen=True)
class Gain:
    """Errors on held-out data, before and after, and the floor that noise sets; all in `unit`."""

    held_out: LeftOut
    rmse_before: float
    rmse_calibrated: float
    rmse_after: float
    noise_floor: float
    unit: str = "arcsec"
    held_out_rows: tuple[int, ...] = ()
    """Of the file, from 0; where means were judged, all rows that they are of."""
    left: Mapping[str, np.ndarray] = field(default_factory=dict, compare=False, repr=False)
    """Measured less predicted angle of what was judged: `before`, `calibrated`, `after`."""
    stated_std: float = 0.0
    """Root mean square of the standard deviation that what was learnt states for these rows, noise aside."""
    elsewhere: bool = False
    """Whether a cause is judged at positions of the wave generator that were all held out with these rows."""

    @property
    def channel(self) -> str:
        """Of which a whole level was held out: an amplitude, a rate, a temperature; else ""."""
        return self.held_out.channel if self.held_out.level else ""


Aim = Literal["more_data", "find_structure", "confirm", "separate"]
DoingKind = Literal[
    "whole_sweeps",
    "more_specimens",
    "warmer",
    "other_rates",
    "beyond_own_rates",
    "hold",
    "larger_torque",
    "other_positions",
    "between_positions",
    "more_cycles",
    "slower",
    "compare_channels",
    "compare_channels_and_cell",
    "weigh_torque_cell",
    "read_torque_zero",
    "same_ends",
    "other_ends",
    "closed_sweep",
    "closed_sweeps",
    "temperatures_in_other_order",
    "check_scales",
]


@dataclass(frozen=True)
class Doing:
    """What a rig is to do; `torques_Nm`: of end points, or the largest of each sweep, where it names them.

    `rated_Nm` : rated torque beside them, where the design states it.
    """

    kind: DoingKind
    torques_Nm: tuple[float, ...] = ()
    rated_Nm: float | None = None


@dataclass(frozen=True)
class NextMeasurement:
    """The measurement that would answer the open question.

    Attributes
    ----------
    vary : the channel or thing to vary. aim : what it is for.
    causes : ids: the one to confirm, or the one to tell from all others.
    doing : what to do, of a plan; None: what shows the cause, or structure in the channel.
    unit : the unit to measure. structure : what to find, None of a plan of its own.
    separation : by how many units of noise the two nearest rivals then differ.
    same_points : the same for end points at the torques measured, None where they were not compared.
    dimension_mm : of a specimen to make, and as drawn.
    """

    vary: str
    aim: Aim
    causes: tuple[str, ...] = ()
    doing: Doing | None = None
    unit: str = ""
    separation: float = 0.0
    same_points: float | None = None
    dimension_mm: tuple[float, float] | None = None
    structure: Structure | None = None


@dataclass(frozen=True)
class DiagnosisOutcome:
    """The verdict and all that goes with it, as facts; `results.diagnosis` puts them into words.

    `too_little` is why there are too few data, of an `insufficient` verdict. `gains_at_levels` are the
    errors on whole amplitudes, rates and temperatures, each predicted from the others.
    """

    verdict: Verdict
    causes: tuple[NamedCause, ...] = ()
    unexplained: tuple[Unexplained, ...] = ()
    gain: Gain | None = None
    next_measurement: NextMeasurement | None = None
    too_little: Shortage | None = None
    gains_at_levels: tuple[Gain, ...] = ()
