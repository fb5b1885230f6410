"""The specimen that would tell rivals apart: one dimension changed, computed by FE."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError, DesignError
from flexspline.geometry.keys import lengths, with_values
from flexspline.pipeline.diagnosis.outcome import NextMeasurement
from flexspline.pipeline.diagnosis.specimens.decide import SpecimenDecision, causes_title
from flexspline.pipeline.diagnosis.specimens.laplace import LaplaceFit
from flexspline.pipeline.diagnosis.specimens.parameters import log_compliance
from flexspline.pipeline.diagnosis.specimens.stiffness import PARTS, Bench, Compliances, compliances

FACTORS = (0.6, 1.6)
"""Of the drawing's dimension: what can still be made and bolted to the same rig."""
ANOTHER_GEAR = ("inner_diameter_mm", "bore_diameter_mm")
"""Not to be changed on the same wave generator, teeth and rig."""
CONFIRM = {
    "youngs_modulus": ("material", "a tensile or resonance test of the same bar gives E directly"),
    "series_compliance": ("fixture", "clamp a solid dummy in the same fixture: what twists is the fixture"),
    "load_zone": ("flexspline.ring_width_mm", "specimens with another ring width, which the lobes feel most"),
}  # fmt: skip


def next_specimen(
    decision: SpecimenDecision, bench: Bench, design: Design, part: str, noise: float
) -> NextMeasurement | None:
    """What to measure next; None where nothing is in doubt."""
    match decision.verdict:
        case "unknown":
            u = decision.unexplained[0]
            return NextMeasurement(
                u.channel,
                f"the structure is {u.what}: repeat those specimens, in another order",
                0.0,
            )
        case "named":
            cause = decision.found[-1].id
            if cause.startswith("geometry:"):
                key = cause.removeprefix("geometry:")
                return NextMeasurement(key, f"measure {key} of the specimens", 0.0)
            vary, why = CONFIRM[cause]
            return NextMeasurement(vary, f"to confirm it: {why}", 0.0)
        case "ambiguous":
            return _separating(decision, bench, design, part, noise)
        case _:
            return None


def _separating(
    decision: SpecimenDecision, bench: Bench, design: Design, part: str, noise: float
) -> NextMeasurement:
    """The dimension whose change drives the two nearest rivals furthest apart."""
    fits = (decision.chosen, *decision.rivals)
    bench.context.progress.note("the specimen that would tell the rivals apart")
    found: list[tuple[float, str, float, float]] = []
    for name in PARTS[part]:
        for key, nominal in lengths(design.part(name)).items():
            for factor in () if key.endswith(ANOTHER_GEAR) else FACTORS:
                value = round(nominal * factor, 3)
                try:
                    other = with_values(design, {key: value})
                    apart = _apart(fits, _compliances(fits, bench, other, part)) / noise
                except (DesignError, ComputationError):
                    continue
                found.append((apart, key, value, nominal))
    titles = " from ".join(
        [
            causes_title(decision.found[0].id),
            " or ".join(causes_title(a) for a in _others(decision)),
        ]
    )
    if not found:
        return NextMeasurement("fixture", f"another fixture, to tell {titles}", 0.0)
    apart, key, value, nominal = max(found)
    return NextMeasurement(
        key,
        f"a specimen with {key} = {value:g} instead of {nominal:g}: the "
        f"predicted stiffnesses nearest to each other then differ by {apart:.1f} times the noise; it tells "
        f"{titles}",
        apart,
    )


def _others(decision: SpecimenDecision) -> tuple[str, ...]:
    return tuple(dict.fromkeys(a for c in decision.found for a in c.alternatives))


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
