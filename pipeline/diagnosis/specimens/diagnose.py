"""Measured stiffness of specimens and a design in, a verdict out: the steps in order.

| step | file |
|---|---|
| the design of each row; which part was measured | `bench.py`, `_parts` below |
| FE of each row: compliance, load zone, sensitivities | `compliances.py`, `sensitivity.py` |
| hypotheses: one parameter each | `parameters.py`, `tolerance.py` |
| race of single parameters and pairs, by evidence | `race.py`, `evidence.py` |
| verdict, causes and rivals | `decide.py`, rules in `../decision.py` |
| FE again at a dimension that was found, then race and verdict again | `compliances.py` |
| error on specimens left out | `_held_out` below |
| next specimen | `next_measurement.py` |
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from flexspline.geometry.design import Design
from flexspline.pipeline.diagnosis.left_out import LeftOut
from flexspline.pipeline.diagnosis.measurement.record import PARTS_IN_ROW, Specimens
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome, Doing, Gain, NextMeasurement
from flexspline.pipeline.diagnosis.robust import rms
from flexspline.pipeline.diagnosis.shortage import FewSpecimens
from flexspline.pipeline.diagnosis.specimens.bench import Bench, row_designs
from flexspline.pipeline.diagnosis.specimens.compliances import compliances, refined
from flexspline.pipeline.diagnosis.specimens.decide import SpecimenExplanation, decide
from flexspline.pipeline.diagnosis.specimens.evidence import LaplaceFit, SpecimenData, fit
from flexspline.pipeline.diagnosis.specimens.finding import GuessedBy, SpecimenAnalysis
from flexspline.pipeline.diagnosis.specimens.next_measurement import next_specimen
from flexspline.pipeline.diagnosis.specimens.parameters import log_compliance, specimen_parameters
from flexspline.pipeline.diagnosis.specimens.race import SpecimenRace, race
from flexspline.pipeline.parts import AnalysisContext

FEWEST_SPECIMENS = 3
"""Fewest specimens: one for the modulus, one for a cause, one to see noise."""
FEWEST_HELD_OUT = 4
"""The rest then still has FEWEST_SPECIMENS specimens."""
FAR_OFF_LOG_K = 0.25
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
    if n < FEWEST_SPECIMENS:
        return _insufficient(n), None
    bench = Bench(context, K_b, K_e, full)
    parts, guessed_by = _parts(bench, designs, specimens)
    fe = compliances(bench, designs, parts)
    std = specimens.stiffness_std_Nm_per_rad
    data = SpecimenData(
        fe,
        -np.log(specimens.stiffness_Nm_per_rad),
        None if std is None else std / specimens.stiffness_Nm_per_rad,
        design.solver.tolerance,
        design.uncertainty.youngs_modulus_pct / 100,
    )
    specimen_race, explanation = explain(bench, data, specimens, design)
    fe, chosen, decision = specimen_race.data.fe, explanation.chosen, explanation.decision
    before, calibrated, after = _held_out(specimen_race.data, chosen)
    analysis = SpecimenAnalysis(
        specimens.specimen, parts, specimens.stiffness_Nm_per_rad, 1 / fe.total,
        np.exp(-log_compliance(fe, (), specimen_race.null_fit.mean)),
        np.exp(-log_compliance(fe, chosen.terms, chosen.mean)),
        chosen.noise, after, before, specimen_race, chosen, full, guessed_by,
    )  # fmt: skip
    gain = None
    if n >= FEWEST_HELD_OUT:
        gain = Gain(
            LeftOut("specimen", each=n), 100 * rms(before), 100 * rms(calibrated), 100 * rms(after),
            100 * rms(chosen.noise), "%", tuple(range(n)),
        )  # fmt: skip
    most = max(set(parts), key=parts.count)
    outcome = DiagnosisOutcome(
        decision.verdict, decision.causes, decision.unexplained, gain,
        next_specimen(explanation, bench, design, most, float(chosen.noise.mean())),
    )  # fmt: skip
    return outcome, analysis


def explain(
    bench: Bench, data: SpecimenData, specimens: Specimens, design: Design
) -> tuple[SpecimenRace, SpecimenExplanation]:
    """The race, run again where a dimension was found: with FE at what was found."""
    one_material = design.material.shaft is None
    specimen_race = race(data, specimen_parameters(data.fe, specimens.overrides, one_material))
    decision = decide(specimen_race, design.load.torque_Nm)
    wrong = [
        (t.sensitivity.key, float(v))
        for t, v in zip(decision.chosen.terms, decision.chosen.mean[1:], strict=True)
        if t.sensitivity is not None and t.owner in decision.chosen.causes
    ]
    if not wrong:
        return specimen_race, decision
    fe = data.fe
    for key, off in wrong:
        fe = refined(bench, fe, key, off)
    specimen_race = race(
        replace(data, fe=fe), specimen_parameters(fe, specimens.overrides, one_material)
    )
    return specimen_race, decide(specimen_race, design.load.torque_Nm)


def _insufficient(n: int) -> DiagnosisOutcome:
    return DiagnosisOutcome(
        "insufficient",
        next_measurement=NextMeasurement("specimen", "more_data", doing=Doing("more_specimens")),
        too_little=FewSpecimens(n, FEWEST_SPECIMENS),
    )


def _parts(
    bench: Bench, designs: Sequence[Design], specimens: Specimens
) -> tuple[tuple[str, ...], GuessedBy]:
    """The part of each row; where the file does not say, by what it was guessed."""
    if specimens.part_recorded:
        return specimens.part, None
    owners = {key.split(".")[0] for key in specimens.overrides} & {"flexspline", "shaft"}
    choices = [*owners, "series"] if len(owners) == 1 else ["series", "flexspline", "shaft"]
    off = {}
    for choice in choices:
        C = [sum(bench.compliance(d, p) for p in PARTS_IN_ROW[choice]) for d in designs]
        off[choice] = float(abs(np.median(np.log(specimens.stiffness_Nm_per_rad * np.array(C)))))
    part = choices[0] if len(owners) == 1 else min(off, key=lambda c: off[c])
    if part != "series" and off[part] > FAR_OFF_LOG_K and off["series"] < off[part] / 2:
        part = "series"
    by_keys = len(owners) == 1 and part in owners
    return (part,) * len(designs), "overridden_keys" if by_keys else "stiffness"


def _held_out(data: SpecimenData, chosen: LaplaceFit) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
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
