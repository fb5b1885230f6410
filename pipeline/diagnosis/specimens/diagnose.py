"""Measured stiffness of specimens and a design in, a verdict out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from flexspline.geometry.design import Design
from flexspline.pipeline.diagnosis.measurement.record import Specimens
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome, Gain, NextMeasurement
from flexspline.pipeline.diagnosis.specimens.decide import SpecimenDecision, causes_title, decide
from flexspline.pipeline.diagnosis.specimens.finding import SpecimenAnalysis
from flexspline.pipeline.diagnosis.specimens.laplace import LaplaceFit, SpecimenData, fit
from flexspline.pipeline.diagnosis.specimens.next_measurement import next_specimen
from flexspline.pipeline.diagnosis.specimens.parameters import log_compliance, specimen_parameters
from flexspline.pipeline.diagnosis.specimens.race import SpecimenRace, race
from flexspline.pipeline.diagnosis.specimens.stiffness import (
    PARTS,
    Bench,
    compliances,
    refined,
    row_designs,
)
from flexspline.pipeline.parts import AnalysisContext

FEWEST = 3
"""One for the modulus, one for a cause, one to see noise."""
FEWEST_HELD_OUT = 4
PLAINLY = 0.25
"""A file that does not say its part is the series' where the flexspline alone is this far off in ln K and
the series less than half as far."""


def diagnose_specimens(
    design: Design,
    specimens: Specimens,
    K_b: float,
    K_e: float,
    context: AnalysisContext,
    full: bool,
) -> tuple[DiagnosisOutcome, SpecimenAnalysis | None]:
    """The verdict and what stands behind it; None where there is too little to fit.

    `K_b`, `K_e` [N·m/rad] of the nominal design. `full`: they came from FE, and rows are solved with
    their holes; else they were given, and are scaled by the ratios of the hole-free model.

    Raises
    ------
    MeasurementError : an override that makes no design.
    """
    designs = row_designs(design, specimens)
    n = len(designs)
    if n < FEWEST:
        return _insufficient(n), None
    bench = Bench(context, K_b, K_e, full)
    parts, notes = _parts(bench, designs, specimens)
    fe = compliances(bench, designs, parts)
    std = specimens.stiffness_std_Nm_per_rad
    data = SpecimenData(
        fe,
        -np.log(specimens.stiffness_Nm_per_rad),
        None if std is None else std / specimens.stiffness_Nm_per_rad,
        design.solver.tolerance_pct / 100,
        design.uncertainty.youngs_modulus_pct / 100,
    )
    found, decision = weighed(bench, data, specimens, design)
    fe, chosen = found.data.fe, decision.chosen
    before, calibrated, after = _held_out(found.data, found.null_fit, chosen)
    analysis = SpecimenAnalysis(
        specimens.specimen, parts, specimens.stiffness_Nm_per_rad, 1 / fe.total,
        np.exp(-log_compliance(fe, (), found.null_fit.mean)),
        np.exp(-log_compliance(fe, chosen.terms, chosen.mean)),
        chosen.noise, after, before, found, chosen,
    )  # fmt: skip
    gain = None
    if n >= FEWEST_HELD_OUT:
        gain = Gain(
            f"each of {n} specimens in turn", _pct(before), _pct(calibrated), _pct(after),
            _pct(chosen.noise), "%", tuple(range(n)),
        )  # fmt: skip
    most = max(set(parts), key=parts.count)
    outcome = DiagnosisOutcome(
        decision.verdict, decision.found, decision.unexplained, gain,
        next_specimen(decision, bench, design, most, float(chosen.noise.mean())),
        _summary(decision), (*notes, *_notes(decision, data, full)),
    )  # fmt: skip
    return outcome, analysis


def weighed(
    bench: Bench, data: SpecimenData, specimens: Specimens, design: Design
) -> tuple[SpecimenRace, SpecimenDecision]:
    """The race, run again where a dimension was found: with FE at what was found."""
    one_material = design.material.shaft is None
    found = race(data, specimen_parameters(data.fe, specimens.overrides, one_material))
    decision = decide(found, design.load.torque_Nm)
    wrong = [
        (t.sensitivity.key, float(v))
        for t, v in zip(decision.chosen.terms, decision.chosen.mean[1:], strict=True)
        if t.sensitivity is not None and t.owner in decision.chosen.named
    ]
    if not wrong:
        return found, decision
    fe = data.fe
    for key, off in wrong:
        fe = refined(bench, fe, key, off)
    found = race(replace(data, fe=fe), specimen_parameters(fe, specimens.overrides, one_material))
    return found, decide(found, design.load.torque_Nm)


def _insufficient(n: int) -> DiagnosisOutcome:
    reason = f"{n} specimen{'s' if n != 1 else ''}; modulus, one cause and the noise need {FEWEST}"
    advice = NextMeasurement(
        "specimen", "measure at least eight specimens whose length, wall and diaphragm differ", 0.0
    )
    return DiagnosisOutcome(
        "insufficient", (), (), None, advice, f"Too little data to say anything: {reason}."
    )


def _parts(
    bench: Bench, designs: Sequence[Design], specimens: Specimens
) -> tuple[tuple[str, ...], list[str]]:
    """The part of each row; where the file does not say, by the overridden keys and the stiffness."""
    if specimens.part_recorded:
        return specimens.part, []
    owners = {key.split(".")[0] for key in specimens.overrides} & {"flexspline", "shaft"}
    choices = [*owners, "series"] if len(owners) == 1 else ["series", "flexspline", "shaft"]
    off = {}
    for choice in choices:
        C = [sum(bench.compliance(d, p) for p in PARTS[choice]) for d in designs]
        off[choice] = float(abs(np.median(np.log(specimens.stiffness_Nm_per_rad * np.array(C)))))
    part = choices[0] if len(owners) == 1 else min(off, key=lambda c: off[c])
    if part != "series" and off[part] > PLAINLY and off["series"] < off[part] / 2:
        part = "series"
    why = "the overridden keys" if len(owners) == 1 and part in owners else "its stiffness"
    return (part,) * len(designs), [f"the file has no column part: taken as {part}, by {why}"]


def _held_out(
    data: SpecimenData, null: LaplaceFit, chosen: LaplaceFit
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(n,) errors of ln K where each specimen is predicted from the others: FE, calibrated, explained."""
    n = len(data.log_compliance)
    before = np.log(data.fe.total) - data.log_compliance
    calibrated, after = np.full(n, np.nan), np.full(n, np.nan)
    if n < FEWEST_HELD_OUT:
        return before, calibrated, after
    for i in range(n):
        rest = np.arange(n) != i
        for out, terms in ((calibrated, ()), (after, chosen.terms)):
            trained = fit(data.rows(rest), [t.rows(rest) for t in terms])
            out[i] = log_compliance(data.fe, terms, trained.mean)[i] - data.log_compliance[i]
    return before, calibrated, after


def _pct(values: np.ndarray) -> float:
    return 100 * float(np.sqrt(np.mean(values**2)))


def _summary(decision: SpecimenDecision) -> str:
    listed = "; ".join(
        f"{c.title}, {c.magnitude:+.3g} ± {c.magnitude_std:.2g} {c.unit}".removesuffix(" 1")
        for c in decision.found
    )
    match decision.verdict:
        case "consistent":
            return "The specimens agree with the simulation within its stated uncertainty and the noise."
        case "named":
            return f"The simulation is wrong in one thing or more: {listed}."
        case "ambiguous":
            rivals = "; ".join(
                f"{c.title} cannot be told from {' or '.join(causes_title(a) for a in c.alternatives)}"
                for c in decision.found if c.alternatives
            )  # fmt: skip
            return f"Something is wrong, and these specimens cannot tell what: {rivals}."
        case _:
            what = "; ".join(u.what for u in decision.unexplained)
            known = f" Beside it: {listed}." if listed else ""
            return f"There is structure that no known cause explains: {what}.{known}"


def _notes(decision: SpecimenDecision, data: SpecimenData, full: bool) -> list[str]:
    chosen = decision.chosen
    notes = [f"one stiffness is taken to be good to {100 * float(chosen.noise.mean()):.2g} %"]
    if data.std is None:
        notes[0] += ", which the scatter says, as the file states none"
    if "youngs_modulus" not in chosen.named:
        notes.append(
            f"Young's modulus calibrated by {100 * chosen.mean[0]:+.2g} % within its uncertainty"
        )
    for term, value in zip(chosen.terms, chosen.mean[1:], strict=True):
        s = term.sensitivity
        if s is not None and term.owner not in chosen.named:
            notes.append(
                f"{s.key} {value:+.2g} mm would suit the data; that is within ± {s.tolerance_mm:g} mm of "
                "ISO 2768-m and no finding"
            )
    source = (
        "solved with their holes"
        if full
        else "the given stiffness times the hole-free model's ratio"
    )
    notes.append(f"rows are {source}; changes with a dimension come from the hole-free model")
    return notes
