"""The report of a diagnosis: its content as finished text, set by a fixed template."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from pipeline.diagnosis.diagnose import Diagnosis
from pipeline.diagnosis.record import EndPoints, Specimens, Sweep
from pipeline.diagnosis.result import Gain, NamedCause, Unexplained
from results.diagnosis.words import (
    VERDICTS,
    calibrated_words,
    capital,
    channel_words,
    figures_text,
    magnitude_words,
    odds_words,
    sentence,
    sure_words,
    title_of,
)
from results.figures.diagnosis.draw import Drawn
from results.quantities import grouped
from results.records import program_version
from results.report.write import ReportError

TEMPLATE = "diagnosis.typ"


@dataclass(frozen=True)
class Stiffnesses:
    """K_b and K_e of the simulation that was compared; `given` says they came from the command."""

    K_b_Nm_per_rad: float
    K_e_Nm_per_rad: float
    given: bool
    error: float = 0.0
    """The solver's relative error of both in series."""


def diagnosis_pdf(
    diagnosis: Diagnosis, figures: Sequence[Drawn], used: Stiffnesses, folder: Path
) -> bytes:
    """The PDF's bytes; `folder` holds the figures and gets the template.

    Text from files reaches typst as strings in a JSON value, never as source.

    Raises
    ------
    ReportError : typst refused the document.
    """
    import typst

    source = folder / TEMPLATE
    source.write_bytes(files("results.report").joinpath(TEMPLATE).read_bytes())
    data = json.dumps(payload(diagnosis, figures, used))
    try:
        return typst.compile(
            str(source), root=str(folder), sys_inputs={"report": data}, timestamp=0
        )
    except typst.TypstError as error:
        raise ReportError(f"typst could not set the report: {error}") from error


def payload(diagnosis: Diagnosis, figures: Sequence[Drawn], used: Stiffnesses) -> dict[str, Any]:
    """The content as JSON values, in the order in which the template sets it."""
    outcome = diagnosis.outcome
    after = outcome.next_measurement
    return {
        "name": diagnosis.design.name,
        "version": program_version(),
        "verdict": outcome.verdict,
        "heading": VERDICTS[outcome.verdict],
        "sentence": sentence(outcome),
        "measured": measured(diagnosis),
        "compared": compared(diagnosis, used),
        "causes": [_cause(c) for c in outcome.causes],
        "unexplained": [_unexplained(u) for u in outcome.unexplained],
        "gain": None if outcome.gain is None else _gain(outcome.gain, bool(outcome.causes)),
        "next": None if after is None else [capital(channel_words(after.vary)), capital(after.why)],
        "notes": [capital(n) for n in outcome.notes],
        "figures": [[f.path.name, f.caption] for f in figures],
        "model": diagnosis.model is not None,
    }


def measured(diagnosis: Diagnosis) -> list[list[str]]:
    """What was measured: name and text of each fact."""
    m = diagnosis.measurement
    if isinstance(m, Sweep):
        return [["Kind", "torque sweep, wave generator locked"], *_sweep(m)]
    if isinstance(m, EndPoints):
        kind, count = "angles at both ends of the torque", f"{len(m.unit)}"
        return [["Kind", kind], ["File", m.path.name], ["Units", count]]
    if isinstance(m, Specimens):
        kind, count = "stiffness of several parts", f"{len(m.specimen)}"
        facts = [["Kind", kind], ["File", m.path.name], ["Specimens", count]]
        return (
            [*facts, ["Varied", ", ".join(map(channel_words, m.overrides))]]
            if m.overrides
            else facts
        )
    return [["File", str(getattr(m, "path", ""))]]


def _sweep(sweep: Sweep) -> list[list[str]]:
    h = sweep.history
    cycles = int(h.cycle.max()) + 1
    facts = [
        ["File", sweep.path.name],
        ["Extent", f"{grouped(len(sweep), 0)} rows, {cycles} cycle{'s' * (cycles > 1)}"
         + (f", {len(sweep.units)} units" if len(sweep.units) > 1 else "")],
        ["Torque", f"{_range(h.torque_Nm)} N·m"],
    ]  # fmt: skip
    if h.time_s is not None:
        seconds = max(float(h.time_s[rows].max() - h.time_s[rows].min()) for rows in h.unit_slices)
        shown = f"{seconds / 3600:.3g} h" if seconds > 7200 else f"{seconds:.4g} s"
        facts.append(["Time", shown])
    if h.temperature_C is not None:
        facts.append(["Temperature", f"{_range(h.temperature_C)} °C"])
    if h.input_angle_deg is not None:
        count = len(set(h.input_angle_deg.tolist()))
        shown = f"{_range(h.input_angle_deg)}°, {count} positions"
        facts.append(["Wave generator", shown if count > 1 else f"at {h.input_angle_deg[0]:g}°"])
    return facts


def _range(values: Any) -> str:
    return f"{figures_text(float(values.min()))} to {figures_text(float(values.max()))}"


def compared(diagnosis: Diagnosis, used: Stiffnesses) -> str:
    """With what the measurement was compared, in one sentence."""
    p = diagnosis.prediction
    if isinstance(diagnosis.measurement, Specimens):
        return _compared_specimens(diagnosis, used)
    source = "as given" if used.given else f"computed, ±{100 * used.error:.2g} %"
    return (
        f"Compared with the simulation: K_b = {grouped(used.K_b_Nm_per_rad, 0)} and "
        f"K_e = {grouped(used.K_e_Nm_per_rad, 0)} N·m/rad ({source}), a gap of "
        f"{grouped(p.gap_arcsec, 1)} ± {grouped(p.gap_std_arcsec, 1)} arcsec, and an elastic twist of "
        f"{figures_text(p.compliance, 4)} ± {figures_text(p.compliance_std, 2)} arcsec for each N·m. A "
        "stiffness or gap that differs within these limits is no finding."
    )


def _compared_specimens(diagnosis: Diagnosis, used: Stiffnesses) -> str:
    doubt = diagnosis.design.uncertainty.youngs_modulus_pct
    source = "scaled from K_b and K_e as given" if used.given else "solved for each specimen"
    return (
        f"Compared with the simulated stiffness, {source}. Young's modulus may be off by {doubt:g} % (1σ), "
        "and a dimension by the general tolerance ISO 2768-m, without that being a finding."
    )


def _cause(cause: NamedCause) -> dict[str, Any]:
    others = ", ".join(map(title_of, cause.alternatives))
    return {
        "title": capital(cause.title),
        "magnitude": magnitude_words(cause),
        "sure": sure_words(cause),
        "odds": "" if cause.alternatives else odds_words(cause.evidence_nats),
        "others": capital(others) or "Nothing that the program knows",
        "units": ", ".join(cause.own_units),
    }


def _unexplained(u: Unexplained) -> dict[str, str]:
    chance = "less than 1 in a million" if u.p_value < 1e-6 else f"1 in {grouped(1 / u.p_value, 0)}"
    return {
        "channel": capital(channel_words(u.channel)),
        "what": capital(u.what),
        "rms": figures_text(u.rms, 2),
        "chance": chance,
    }


def _gain(gain: Gain, found: bool) -> dict[str, Any]:
    zeroed = ", its zero fitted" if gain.unit == "arcsec" else ""
    rows = [
        (f"The simulation as it stands{zeroed}", gain.rmse_before),
        (f"{capital(calibrated_words(gain))}, no cause added", gain.rmse_calibrated),
    ]
    if found:
        rows.append(("With the causes found", gain.rmse_after))
    rows.append(("Noise of the reading itself, the floor", gain.noise_floor))
    above = gain.rmse_before**2 - gain.noise_floor**2
    share = (gain.rmse_before**2 - gain.rmse_after**2) / above if above > 0 else 0.0
    return {
        "held_out": gain.held_out,
        "unit": gain.unit,
        "rows": [[name, figures_text(value)] for name, value in rows],
        "share": _percent(share) if found and share > 0 else "",
    }


def _percent(share: float) -> str:
    """Never rounded up to all: 99.97 % is 99.9 %."""
    if share >= 1:
        return "100"
    return f"{int(1000 * share) / 10:.1f}" if share > 0.99 else f"{100 * share:.0f}"
