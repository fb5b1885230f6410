"""The specimen that would tell rivals apart: one dimension changed, computed by FE."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError, DesignError
from flexspline.geometry.keys import lengths, with_values
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.measurement.record import PARTS_IN_ROW
from flexspline.pipeline.diagnosis.outcome import NextMeasurement
from flexspline.pipeline.diagnosis.specimens.bench import Bench
from flexspline.pipeline.diagnosis.specimens.cause_ids import GEOMETRY, LOAD_ZONE, YOUNGS_MODULUS
from flexspline.pipeline.diagnosis.specimens.compliances import Compliances, compliances
from flexspline.pipeline.diagnosis.specimens.decide import SpecimenExplanation
from flexspline.pipeline.diagnosis.specimens.evidence import LaplaceFit
from flexspline.pipeline.diagnosis.specimens.parameters import log_compliance

DIMENSION_FACTORS = (0.6, 1.6)
"""New dimension over the drawing's: such parts can still be made and bolted to the same rig. Judgement."""
ANOTHER_GEAR = ("inner_diameter_mm", "bore_diameter_mm")
"""Not to be changed on the same wave generator, teeth and rig."""
CONFIRM = {YOUNGS_MODULUS: "material", SERIES: "fixture",
           LOAD_ZONE: "flexspline.ring_width_mm"}  # fmt: skip
"""What to vary or look at to confirm a cause; of a dimension, itself."""


def next_specimen(
    explanation: SpecimenExplanation, bench: Bench, design: Design, part: str, noise: float
) -> NextMeasurement | None:
    """What to measure next; None where nothing is in doubt."""
    decision = explanation.decision
    match decision.verdict:
        case "unknown":
            u = decision.unexplained[0]
            return NextMeasurement(u.channel, "find_structure", structure=u.structure)
        case "ambiguous" if explanation.rivals:
            return _separating(explanation, bench, design, part, noise)
        case "named" | "ambiguous":
            cause = decision.causes[-1].id
            vary = CONFIRM.get(cause) or cause.removeprefix(GEOMETRY)
            return NextMeasurement(vary, "confirm", (cause,))
        case _:
            return None


def _separating(
    explanation: SpecimenExplanation, bench: Bench, design: Design, part: str, noise: float
) -> NextMeasurement:
    """The dimension whose change drives the two nearest rivals furthest apart."""
    fits = (explanation.chosen, *explanation.rivals)
    bench.context.progress.note("the specimen that would tell the rivals apart")
    candidates: list[tuple[float, str, float, float]] = []
    for name in PARTS_IN_ROW[part]:
        for key, nominal in lengths(design.part(name)).items():
            for factor in () if key.endswith(ANOTHER_GEAR) else DIMENSION_FACTORS:
                value = round(nominal * factor, 3)
                try:
                    other = with_values(design, {key: value})
                    apart = _apart(fits, _compliances(fits, bench, other, part)) / noise
                except (DesignError, ComputationError):
                    continue
                candidates.append((apart, key, value, nominal))
    causes = explanation.decision.causes
    others = dict.fromkeys(a for c in causes for a in c.alternatives)
    ids = (causes[0].id, *others)
    if not candidates:
        return NextMeasurement("fixture", "separate", ids)
    apart, key, value, drawn = max(candidates)
    return NextMeasurement(key, "separate", ids, separation=apart, dimension_mm=(value, drawn))


def _compliances(
    fits: Sequence[LaplaceFit], bench: Bench, design: Design, part: str
) -> Compliances:
    terms = [t for f in fits for t in f.terms]
    keys = {t.sensitivity.key for t in terms if t.sensitivity is not None}
    return compliances(bench, (design,), (part,), keys, any(t.kind == "zone" for t in terms))


def _apart(fits: Sequence[LaplaceFit], fe: Compliances) -> float:
    """Smallest difference of ln C between the first fit and a rival at a new specimen."""
    by_key = {s.key: s for s in fe.sensitivities}
    values = []
    for f in fits:
        terms = [
            t if t.sensitivity is None else replace(t, sensitivity=by_key[t.sensitivity.key])
            for t in f.terms
        ]  # fmt: skip
        values.append(float(log_compliance(fe, terms, f.mean)[0]))
    return min(abs(v - values[0]) for v in values[1:])
