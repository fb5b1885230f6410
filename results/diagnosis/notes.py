"""What a reader should know of how a record was used, one line each."""

from __future__ import annotations

from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.specimens.finding import SpecimenAnalysis
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep
from flexspline.results.diagnosis.end_point_notes import end_point_notes
from flexspline.results.diagnosis.words import title_of


def notes(diagnosis: Diagnosis) -> tuple[str, ...]:
    """Notes of the kind that was measured."""
    if diagnosis.sweep is not None:
        return (*_sweep_notes(diagnosis.sweep.explained),)
    if diagnosis.end_points is not None:
        return (*end_point_notes(diagnosis.end_points),)
    if diagnosis.specimens is not None:
        return (*_specimen_notes(diagnosis.specimens),)
    return ()


def _sweep_notes(explained: ExplainedSweep) -> list[str]:
    prepared = explained.prepared
    found = []
    dropped = int(prepared.outlier.sum())
    if dropped:
        found.append(f"{dropped} isolated outliers were left out")
    band = f"rows with |T| < {prepared.band_Nm:.3g} N·m (backlash crossing)"
    found.append(f"{band} were not used for identification")
    if prepared.sweep.history.time_s is None:
        found.append("no time was recorded: friction cannot be told from rate dependence")
    found += _unit_notes(explained)
    if prepared.sweep.ignored:
        found.append(f"columns not used: {', '.join(prepared.sweep.ignored)}")
    return found


def _unit_notes(explained: ExplainedSweep) -> list[str]:
    """What the units have in common, and how they differ."""
    names = explained.prepared.sweep.units
    found = []
    for cause, shares in explained.shares.items():
        title = title_of(cause)
        if not shares.differ:
            found.append(f"{title}: common to all {len(names)} units")
            continue
        each = ", ".join(
            f"{n} {s:.2f} ± {d:.2f}"
            for n, s, d in zip(names, shares.share, shares.share_std, strict=True)
        )
        found.append(f"{title}: differs between units; shares of the common effect: {each}")
    return found


def _specimen_notes(analysis: SpecimenAnalysis) -> list[str]:
    chosen = analysis.chosen
    noise = f"one stiffness is taken to be good to {100 * float(chosen.noise.mean()):.2g} %"
    if analysis.race.data.std is None:
        noise += ", which the scatter says, as the file states none"
    found = [noise]
    if analysis.part_guessed_by:
        part = analysis.part[0]
        found.insert(
            0, f"the file has no column part: taken as {part}, by {analysis.part_guessed_by}"
        )
    if "youngs_modulus" not in chosen.named:
        change = f"{100 * chosen.mean[0]:+.2g}".replace("-", "−")
        found.append(f"Young's modulus calibrated by {change} % within its uncertainty")
    for term, value in zip(chosen.terms, chosen.mean[1:], strict=True):
        s = term.sensitivity
        if s is not None and term.owner not in chosen.named:
            change = f"{value:+.2g}".replace("-", "−")
            found.append(
                f"{s.key} {change} mm would suit the data; that is within ± {s.tolerance_mm:g} mm of "
                "ISO 2768-m and no finding"
            )
    how = (
        "solved with their holes"
        if analysis.with_holes
        else "the given stiffness times the hole-free model's ratio"
    )
    found.append(f"rows are {how}; changes with a dimension come from the hole-free model")
    return found
