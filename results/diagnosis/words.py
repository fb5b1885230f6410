"""Words for the findings of a diagnosis, common to console, figures and report."""

from __future__ import annotations

from collections.abc import Mapping
from math import log

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.outcome import (
    SIZE_KNOWN,
    DiagnosisOutcome,
    Gain,
    NamedCause,
    ScaleError,
)
from flexspline.pipeline.diagnosis.specimens.cause_ids import GEOMETRY, LOAD_ZONE, YOUNGS_MODULUS
from flexspline.pipeline.diagnosis.sweep.calibrated_residual import ALLOWED_SIGMAS
from flexspline.results.diagnosis.channels import channel_words
from flexspline.results.numbers import decimals_for, figures_text, grouped

SPECIMENS = {
    YOUNGS_MODULUS: "material softer or stiffer than stated",
    LOAD_ZONE: "load that enters at the lobes, not uniformly",
}
"""Causes that only specimens show."""
VERDICTS = {
    "consistent": "No effect that the simulation leaves out",
    "named": "Causes identified",
    "ambiguous": "Several causes are possible; these data do not separate them",
    "unknown": "An effect that no known cause explains",
    "insufficient": "Too little data for a verdict",
}
"""Headings."""
EVIDENCE_WORDS = ((10.0, "beyond doubt"), (5.0, "very sure"), (3.0, "sure"), (1.0, "likely"))
"""Nats of evidence, and how sure that is in words: odds of e to that power, 22 000, 150, 20 and 3 to 1."""

SIZE_AS_NONE = 1.0
"""Standard deviations from no effect, below which a size is as good as none: beside it no "beyond doubt"."""
SCALE_ERRORS: Mapping[ScaleError, str] = {"angle": "scale of the angle", "unit": "unit"}
"""What may be wrong of a reading in place of an elastic part."""
WIDE = " wide at T = 0"
"""What the size of friction's loop is."""
WIDER_RATIO = 1.1
"""Times the width at T = 0 that a friction loop is somewhere else, where it is said."""


def sure_words(cause: NamedCause) -> str:
    """How sure a cause is, in words, from its evidence; rivals lower it."""
    if cause.alternatives:
        return "not decided"
    if cause.or_scale:
        return f"not decided: elastic part or {SCALE_ERRORS[cause.or_scale]}"
    # the evidence may be strong that there is an effect, its size nevertheless uncertain
    words = next((words for least, words in EVIDENCE_WORDS if cause.evidence_nats >= least), "weak")
    if cause.or_temperature:
        words += ", time or temperature undecided"
    if cause.deviations >= SIZE_KNOWN or _is_wider(cause):  # of a loop that closes at T = 0
        return words
    if cause.deviations < SIZE_AS_NONE:
        return "an effect exists, its size is not known"
    return f"{words}, size uncertain"


def odds_words(nats: float) -> str:
    """Evidence as odds, e^nats to 1, in words."""
    exponent = nats / log(10)
    if exponent > 6:
        return "more than a million to 1"
    return f"about {grouped(float(f'{10**exponent:.1g}'), 0)} to 1"


def factor_words(cause: NamedCause) -> str:
    """Of a ratio, what is so many times what; "" of a size that has a unit."""
    known = known_causes().get(cause.id)
    return known.factor if known and cause.unit == "1" else ""


def plus_minus(value: float, std: float) -> str:
    """Value and standard deviation with the same decimals, two digits of the deviation."""
    scale = std if std > 0 else abs(value) / 100
    places = min(8, decimals_for(scale, 2))
    return f"{grouped(value, places)} ± {grouped(std, places)}"


def magnitude_words(cause: NamedCause) -> str:
    """Magnitude, deviation and unit; of friction, that it is the loop's full width at zero torque.

    A gear that is stiffer than simulated is told in stiffness; the magnitude of the record is of compliance.
    """
    if cause.is_surplus:
        return f"+{plus_minus(*cause.stiffer_pct)} %"
    where = WIDE if cause.id == FRICTION else ""
    size = plus_minus(cause.magnitude, cause.magnitude_std)
    unit = factor_words(cause) if cause.unit == "1" else cause.unit
    return f"{size} {unit}".rstrip() + where


def _is_wider(cause: NamedCause) -> bool:
    """Whether friction's loop is much wider elsewhere than at T = 0, where its magnitude is."""
    widest = cause.widest_arcsec
    return widest is not None and widest > WIDER_RATIO * abs(cause.magnitude)


def title_of(cause_id: str, magnitude: float = 0.0) -> str:
    """A cause's title; of a dimension, which one. The sign of the magnitude may change what it is."""
    if cause_id in SPECIMENS:
        return SPECIMENS[cause_id]
    if cause_id.startswith(GEOMETRY):
        return f"{channel_words(cause_id.removeprefix(GEOMETRY))} other than drawn"
    cause = known_causes().get(cause_id)
    return cause.title_at(magnitude) if cause else cause_id


def ratio_words(cause: NamedCause) -> str:
    """Of which ratio a size in % or 1 is; "" of one that has its own unit."""
    if cause.is_surplus:
        return "in % of the simulated stiffness"
    known = known_causes().get(cause.id)
    return known.ratio if known else ""


def cause_title(cause: NamedCause) -> str:
    """What a person reads of a cause found."""
    more = []
    if cause.ahead_Nm:
        torque = plus_minus(cause.ahead_Nm, cause.ahead_std_Nm)
        more.append(f"{torque} N·m of friction ahead of the gap")
    if cause.widest_arcsec is not None and _is_wider(cause):
        more.append(f"loop up to {figures_text(cause.widest_arcsec)} arcsec wide")
    if cause.or_temperature:
        more.append("with time or temperature")
    if cause.or_scale:
        more.append(f"or a wrong {SCALE_ERRORS[cause.or_scale]}")
    title = title_of(cause.id, cause.magnitude)
    return f"{title} ({', '.join(more)})" if more else title


def calibrated_words(gain: Gain) -> str:
    """What was fitted beside the causes: of specimens only the modulus is free."""
    if gain.unit == "%":
        return "Young's modulus fitted"
    if gain.held_out.each:  # end points
        return "stiffness and gap calibrated"
    return f"stiffness and gap calibrated within {ALLOWED_SIGMAS:g} stated deviations"


def free_words(outcome: DiagnosisOutcome) -> str:
    """Of a record without causes, how its calibration may move so that it is the one stated; "" else."""
    gain = outcome.gain
    if gain is None or outcome.verdict != "consistent":
        return ""
    if gain.unit == "%" and gain.rmse_after != gain.rmse_calibrated:
        return "modulus and one dimension within its tolerance fitted"
    if gain.held_out.each:
        return ""
    return "stiffness and gap calibrated without this limit"


def noise_words(gain: Gain) -> str:
    """Whose noise the gain's floor is: of the rows held out, or of all where each was held out in turn."""
    return "noise of the reading" if gain.held_out.each else "noise of the held-out rows"
