"""A measurement and a design in, a diagnosis out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot
from pathlib import Path

import numpy as np

from geometry.design import Design
from pipeline.cache import Cache
from pipeline.chain import CACHED_TYPES
from pipeline.diagnosis.effects import causes
from pipeline.diagnosis.effects.cause import Element
from pipeline.diagnosis.end_points.diagnose import diagnose_end_points
from pipeline.diagnosis.end_points.finding import EndPointAnalysis
from pipeline.diagnosis.fleet import unit_shares
from pipeline.diagnosis.holdout import gain_of
from pipeline.diagnosis.leftover import SIGNIFICANT, ChannelTest, channel_tests
from pipeline.diagnosis.model import ExtendedModel
from pipeline.diagnosis.next_measurement import FALLBACK, to_tell_apart
from pipeline.diagnosis.prediction import Prediction, prediction_of
from pipeline.diagnosis.record import EndPoints, Specimens, Sweep, read_measurement
from pipeline.diagnosis.result import NamedCause, NextMeasurement, Outcome, Unexplained
from pipeline.diagnosis.search import Candidate
from pipeline.diagnosis.solution import Solution, solved
from pipeline.diagnosis.specimens.diagnose import diagnose_specimens
from pipeline.diagnosis.specimens.finding import SpecimenAnalysis
from pipeline.diagnosis.sweep import FEWEST_KEPT, Explained, diagnosed
from pipeline.diagnosis.weighing import Weighed
from pipeline.parts import Workshop
from pipeline.progress import Progress
from pipeline.storage import cache_folder

UNEXPLAINED_SHARE = 0.5
"""Of the named effects' rms: with more left unexplained the verdict is `unknown`."""
SURE = 1e-8
"""p-value of a channel's structure that, with nothing named, makes the verdict `unknown`."""
STILL = 0.1
"""Torque that varies by less than this share of its largest value is constant."""
SHAPE_NATS = 3.0
"""Sets of shapes count in a magnitude's doubt by exp(−nats/3): no shape is exactly the gear's."""
MOST_SHAPES = 24
SHAPE_FLOOR = {"torque_offset": 0.0}
SHAPE_FLOOR_DEFAULT = 0.01


@dataclass(frozen=True)
class Diagnosis:
    """What was found, with all that a report needs.

    Attributes
    ----------
    outcome : the verdict, causes, gain. explained : the race, None where it was not run.
    model : the extended model, None where nothing was fitted.
    """

    design: Design
    measurement: Sweep | EndPoints | Specimens
    prediction: Prediction
    outcome: Outcome
    explained: Explained | None = None
    model: ExtendedModel | None = None
    end_points: EndPointAnalysis | None = None
    specimens: SpecimenAnalysis | None = None


def diagnose_file(
    design: Design, csv: Path, K_b: float, K_e: float, K_error: float = 0.0, shop: Workshop | None = None
) -> Diagnosis:
    """Read a measurement and diagnose it.

    Stiffnesses in N·m/rad; `K_error` is the solver's relative error of them in series. `shop`, where
    they came from FE: specimens are then solved like the design; without it, given stiffnesses are
    scaled from specimen to specimen by the hole-free model.

    Raises
    ------
    MeasurementError : the file cannot be accepted.
    BearingPlayDomainError : bearing play beyond c_max (involute model).
    """
    measurement = read_measurement(csv)
    prediction = prediction_of(design, K_b, K_e, K_error)
    if isinstance(measurement, Sweep):
        return diagnose_sweep(design, measurement, prediction)
    if isinstance(measurement, EndPoints):
        outcome, analysis, model = diagnose_end_points(design, measurement, prediction)
        return Diagnosis(design, measurement, prediction, outcome, model=model, end_points=analysis)
    bench = shop or _quiet_shop(design)
    outcome, found = diagnose_specimens(design, measurement, K_b, K_e, bench, full=shop is not None)
    return Diagnosis(design, measurement, prediction, outcome, specimens=found)


def _quiet_shop(design: Design) -> Workshop:
    """For the hole-free model's ratios, where stiffnesses were given."""
    return Workshop(design, Cache(cache_folder(), CACHED_TYPES), Progress())


def diagnose_sweep(design: Design, sweep: Sweep, prediction: Prediction) -> Diagnosis:
    """Diagnose a torque sweep."""
    reason = _too_little(sweep)
    if reason:
        return _insufficient(design, sweep, prediction, reason)
    explained = diagnosed(sweep, prediction)
    weighed = explained.weighed
    if int(explained.prepared.kept.sum()) < FEWEST_KEPT:
        return _insufficient(design, sweep, prediction, "too few rows lie outside the gap's crossing")
    found = _named_causes(explained)
    model = model_of(weighed.solution, sweep, [c.id for c in found], explained.offset_Nm)
    tests = channel_tests(explained.prepared, weighed.solution)
    unexplained = _unexplained(explained, tests)
    verdict = _verdict(explained, found, tests)
    if verdict == "consistent":
        unexplained = ()
    outcome = Outcome(
        verdict,
        found,
        unexplained,
        gain_of(explained, [c.id for c in found]) if verdict != "insufficient" else None,
        _next(explained, found, verdict, unexplained),
        _summary(verdict, found, unexplained),
        _notes(explained),
    )
    return Diagnosis(design, sweep, prediction, outcome, explained, model)


def _too_little(sweep: Sweep) -> str | None:
    torque = sweep.history.torque_Nm
    largest = float(np.abs(torque).max())
    if largest == 0 or np.ptp(torque) < STILL * largest:
        return "the torque is constant, so neither stiffness nor gap can be seen"
    kept = np.abs(torque) > 0.035 * largest
    if kept.sum() < FEWEST_KEPT:
        return f"only {int(kept.sum())} rows lie outside the gap's crossing; {FEWEST_KEPT} are needed"
    if len(np.unique(np.round(torque / largest, 2))) < 4:
        return "fewer than four different torques"
    return None


def _insufficient(design: Design, sweep: Sweep, prediction: Prediction, reason: str) -> Diagnosis:
    advice = NextMeasurement(
        "torque_Nm", "sweep the torque 0 → +T → 0 → −T → 0 twice, with at least 100 rows a cycle", 0.0
    )
    summary = f"Too little data to say anything: {reason}."
    return Diagnosis(design, sweep, prediction, Outcome("insufficient", (), (), None, advice, summary))


def _named_causes(explained: Explained) -> tuple[NamedCause, ...]:
    weighed = explained.weighed
    posterior = _probabilities(weighed)
    magnitude, std = magnitudes(weighed)
    timeless = explained.prepared.sweep.history.time_s is None
    found = []
    for c in weighed.named:
        rivals = weighed.rivals[c]
        if timeless and c in ("friction_hysteresis", "rate_dependence"):
            other = {"friction_hysteresis": "rate_dependence"}.get(c, "friction_hysteresis")
            rivals = tuple(dict.fromkeys((*rivals, other)))
        found.append(NamedCause(
            c, causes()[c].title, posterior.get(c, 0.0), rivals, magnitude[c], std[c],
            causes()[c].unit, weighed.evidence.get(c, 0.0), weighed.rms[c],
            _own_units(explained, c),
        ))  # fmt: skip
    if explained.offset_Nm and explained.crossing is not None:
        offset = causes()["torque_offset"]
        slope = weighed.solution.measured_rig().compliance
        found.append(NamedCause(
            offset.id, offset.title, float(1 / (1 + np.exp(-explained.offset_nats + 4))), (),
            explained.offset_Nm, explained.crossing.std_Nm, offset.unit, explained.offset_nats,
            abs(slope * explained.offset_Nm),
        ))  # fmt: skip
    return tuple(sorted(found, key=lambda c: -c.rms_arcsec))


def _own_units(explained: Explained, cause: str) -> tuple[str, ...]:
    """Names of the units that alone show a cause."""
    names = explained.prepared.sweep.units
    if len(names) < 2:
        return ()
    return tuple(names[u] for u in unit_shares(explained.weighed, cause).own)


def _probabilities(weighed: Weighed) -> dict[str, float]:
    """Posterior probability that each cause is in the set, over all sets weighed."""
    race = weighed.search.race
    scored = list(weighed.search.best.values())
    top = max(c.score for c in scored)
    weight = np.array([np.exp(c.score - top) for c in scored])
    names = [c.named(race) for c in scored]
    return {
        cause: min(1.0, float(sum(w for w, n in zip(weight, names, strict=True) if cause in n) / weight.sum()))
        for cause in weighed.named
    }


def magnitudes(weighed: Weighed) -> tuple[dict[str, float], dict[str, float]]:
    """Magnitude of each named cause and its standard deviation, doubt of the shapes included."""
    race = weighed.search.race
    names = weighed.best.named(race)
    alike = sorted(
        {c.terms: c for c in (*weighed.search.weighed, weighed.best) if c.named(race) == names}.values(),
        key=lambda c: -c.score,
    )[:MOST_SHAPES]
    alike = [c for c in alike if c.score > weighed.best.score - 6 * SHAPE_NATS]
    weight = np.exp([(c.score - weighed.best.score) / SHAPE_NATS for c in alike])
    weight /= weight.sum()
    each = [solved(race, c.terms).magnitudes() for c in alike]
    best = weighed.solution.magnitudes()
    own = weighed.solution.magnitude_stds()
    std = {}
    for cause in weighed.named:
        values = np.array([m[cause] for m in each])
        spread = float(np.sqrt(weight @ (values - best[cause]) ** 2))
        floor = SHAPE_FLOOR.get(cause, SHAPE_FLOOR_DEFAULT) * abs(best[cause])
        std[cause] = hypot(own[cause], spread, floor)
    return best, std


def model_of(
    solution: Solution, sweep: Sweep, named: Sequence[str], offset_Nm: float
) -> ExtendedModel:
    """The fitted model, with the elements of the named causes."""
    mean, k, p = solution.fit.mean, solution.units, solution.rig.prediction
    elements = {c: e for c, e in solution.elements().items() if c in named}
    if offset_Nm:
        elements["torque_offset"] = (Element({}, (offset_Nm,)),)
    own = {}
    if k > 1:
        pairs = mean[k + 2 : k + 2 + 2 * k].reshape(k, 2)
        own = {name: (float(a), float(b)) for name, (a, b) in zip(sweep.units, pairs, strict=True)}
    return ExtendedModel(
        p.compliance + float(mean[k]),
        p.gap_arcsec + float(mean[k + 1]),
        {name: float(z) for name, z in zip(sweep.units, mean[:k], strict=True)},
        elements,
        own,
    )


def _verdict(
    explained: Explained, found: Sequence[NamedCause], tests: Sequence[ChannelTest]
) -> str:
    weighed = explained.weighed
    named = hypot(*(c.rms_arcsec for c in found)) if found else 0.0
    if weighed.unnamed_rms > UNEXPLAINED_SHARE * named:
        return "unknown"
    if not found:
        sure = any(t.p_value < SURE for t in tests)
        return "unknown" if sure else "consistent"
    return "ambiguous" if any(c.alternatives for c in found) else "named"


def _unexplained(explained: Explained, tests: Sequence[ChannelTest]) -> tuple[Unexplained, ...]:
    weighed = explained.weighed
    found = []
    for owner, rms in sorted(weighed.rms.items(), key=lambda item: -item[1]):
        if not owner.startswith("?"):
            if owner not in weighed.named:
                found.append(Unexplained("torque_Nm", rms, 1e-6, f"a trace like {causes()[owner].title}"))
            continue
        what = {
            weighed.search.race.terms[i].what
            for i in weighed.best.terms
            if weighed.search.race.terms[i].owner == owner
        }
        found.append(Unexplained(owner[1:], rms, 1e-6, "; ".join(sorted(what))))
    said = {u.channel for u in found}
    for t in sorted(tests, key=lambda t: t.p_value):
        if t.p_value < SIGNIFICANT and t.channel not in said:
            found.append(Unexplained(t.channel, t.rms_arcsec, t.p_value, "what the best model leaves"))
    return tuple(found)


def _next(
    explained: Explained, found: Sequence[NamedCause], verdict: str, unexplained: Sequence[Unexplained]
) -> NextMeasurement | None:
    if verdict == "unknown" and unexplained:
        worst = unexplained[0]
        return NextMeasurement(
            worst.channel,
            f"the structure lies in {worst.channel} ({worst.what}): vary it alone, everything else held", 0.0,
        )  # fmt: skip
    unsure = [c for c in found if c.alternatives] or list(found[-1:])
    if not unsure:
        return None
    cause = unsure[0]
    weighed = explained.weighed
    sweep = explained.prepared.sweep
    rivals = cause.alternatives
    models = [model_of(weighed.solution, sweep, [c.id for c in found], explained.offset_Nm)]
    rival = weighed.rival_sets.get(cause.id)
    if rival is not None and rivals:
        models.append(_rival_model(explained, rival))
    if not rivals:
        vary = FALLBACK.get(cause.id, "torque_Nm")
        return NextMeasurement(vary, f"to confirm {cause.title}: {causes()[cause.id].reveals}", 0.0)
    return to_tell_apart(explained.prepared, models, cause.id, rivals)


def _rival_model(explained: Explained, rival: Candidate) -> ExtendedModel:
    solution = solved(explained.weighed.search.race, rival.terms)
    return model_of(
        solution, explained.prepared.sweep, sorted(solution.elements()), explained.offset_Nm
    )


def _summary(
    verdict: str, found: Sequence[NamedCause], unexplained: Sequence[Unexplained]
) -> str:
    listed = "; ".join(
        f"{c.title}, {c.magnitude:.4g} ± {c.magnitude_std:.2g} {c.unit}".replace(" 1", " ") if c.unit == "1"
        else f"{c.title}, {c.magnitude:.4g} ± {c.magnitude_std:.2g} {c.unit}"
        for c in found
    )  # fmt: skip
    where = ", ".join(dict.fromkeys(u.channel for u in unexplained))
    match verdict:
        case "consistent":
            return "The measurement agrees with the simulation within its stated uncertainty and the noise."
        case "named":
            return f"The simulation leaves out: {listed}."
        case "ambiguous":
            rivals = "; ".join(
                f"{c.title} cannot be told from {' or '.join(causes()[r].title for r in c.alternatives)}"
                for c in found if c.alternatives
            )  # fmt: skip
            return f"Something is missing from the simulation, and these data cannot tell what: {rivals}."
        case _:
            known = f" Beside it: {listed}." if found else ""
            return f"There is structure in {where or 'the data'} that no known cause explains.{known}"


def _fleet_notes(explained: Explained) -> list[str]:
    """What the units have in common, and how they differ."""
    names = explained.prepared.sweep.units
    if len(names) < 2:
        return []
    notes = []
    for cause in explained.weighed.named:
        shares = unit_shares(explained.weighed, cause)
        title = causes()[cause].title
        if not shares.differ:
            notes.append(f"{title}: common to all {len(names)} units")
            continue
        each = ", ".join(
            f"{n} {s:.2f} ± {d:.2f}" for n, s, d in zip(names, shares.share, shares.share_std, strict=True)
        )
        notes.append(f"{title}: differs between units; shares of the common effect: {each}")
    return notes


def _notes(explained: Explained) -> tuple[str, ...]:
    prepared = explained.prepared
    notes = []
    dropped = int(prepared.outlier.sum())
    if dropped:
        notes.append(f"{dropped} isolated outliers were left out")
    notes.append(f"rows with |T| below {prepared.band_Nm:.3g} N·m cross the gap and name no cause")
    if prepared.sweep.history.time_s is None:
        notes.append("no time was recorded: friction cannot be told from rate dependence")
    notes += _fleet_notes(explained)
    if prepared.sweep.ignored:
        notes.append(f"columns not used: {', '.join(prepared.sweep.ignored)}")
    return tuple(notes)
