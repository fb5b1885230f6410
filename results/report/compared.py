"""The measurement, and the simulation with which it was compared, in words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexspline.geometry.listed import joined
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.measurement.record import EndPoints, Specimens, Sweep
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.stiffness_pair import StiffnessPair
from flexspline.results.diagnosis.channels import channel_words
from flexspline.results.diagnosis.data_used import rows_used
from flexspline.results.diagnosis.words import plus_minus
from flexspline.results.numbers import figures_text, grouped


def measured(diagnosis: Diagnosis) -> list[list[str]]:
    """What was measured: name and text of each fact."""
    facts = _facts(diagnosis)
    if diagnosis.sweep is not None:
        facts.append(["Rows used", rows_used(diagnosis.sweep.explained.prepared)])
    return facts


def _facts(diagnosis: Diagnosis) -> list[list[str]]:
    m = diagnosis.measurement
    if isinstance(m, Sweep):
        return [["Kind", "torque sweep, wave generator locked"], *_sweep(m)]
    if isinstance(m, EndPoints):
        kind, count = "angles at both ends of the torque", _counted(m.unit)
        return [["Kind", kind], ["File", m.path.name], ["Units", count]]
    if isinstance(m, Specimens):
        kind, count = "stiffness of several parts", _counted(m.specimen)
        facts = [["Kind", kind], ["File", m.path.name], ["Specimens", count]]
        return (
            [*facts, ["Varied", ", ".join(map(channel_words, m.overrides))]]
            if m.overrides
            else facts
        )
    return [["File", str(getattr(m, "path", ""))]]


def _counted(names: Sequence[str]) -> str:
    """How many different names, and how many rows where some have several."""
    count, rows = len(set(names)), len(names)
    return f"{count}" if count == rows else f"{count} ({rows} rows)"


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


def compared(diagnosis: Diagnosis, used: StiffnessPair) -> str:
    """With what the measurement was compared, in one sentence."""
    p = diagnosis.prediction
    if isinstance(diagnosis.measurement, Specimens):
        return _compared_specimens(diagnosis, used)
    stated = plus_minus(p.gap_arcsec, p.gap_std_arcsec) if p.gap_std_arcsec else ""
    gap = f"a gap of {stated or grouped(p.gap_arcsec, 1)} arcsec"
    if p.bend is not None:
        most = max(map(abs, p.bend.angle_arcsec))
        return (
            "Compared with the simulated torque-angle curve of the whole gear (contact of teeth, rim, race "
            f"and balls): {gap}, a chord of {_twist(p)} arcsec for each N·m up to "
            f"{p.bend.torque_Nm[-1]:.4g} N·m, and deviations of up to {most:.3g} arcsec from this chord. "
            f"{_what_counts(p)}"
        )
    source = "as given" if used.given else f"computed, ± {100 * used.error:.2g} %"
    return (
        f"Compared with the simulation: K_b = {grouped(used.K_b_Nm_per_rad, 0)} and "
        f"K_e = {grouped(used.K_e_Nm_per_rad, 0)} N·m/rad ({source}), {gap}, and an elastic twist of "
        f"{_twist(p)} arcsec for each N·m. {_what_counts(p)}"
    )


def _twist(p: Prediction) -> str:
    """As the calibrated one is printed beside it."""
    stated = plus_minus(p.compliance, p.compliance_std) if p.compliance_std else ""
    return stated or figures_text(p.compliance, 4)


def _what_counts(p: Prediction) -> str:
    """What the standard deviations mean, and what it means that one is missing."""
    missing = [
        name
        for name, std in (("the gap", p.gap_std_arcsec), ("the stiffness", p.compliance_std))
        if not std
    ]
    if not missing:
        return "A stiffness or gap that differs within these limits is not a finding."
    return (
        f"No uncertainty of {joined(missing, 'or')} is stated, so every difference beyond the noise is a "
        "finding."
    )


def _compared_specimens(diagnosis: Diagnosis, used: StiffnessPair) -> str:
    doubt = diagnosis.design.uncertainty.youngs_modulus_pct
    modulus = (
        f"The stated uncertainty of Young's modulus is {doubt:g} % (1σ)"
        if doubt
        else "No uncertainty of Young's modulus is stated, so the modulus is taken as exact"
    )
    source = "scaled from K_b and K_e as given" if used.given else "solved for each specimen"
    return (
        f"Compared with the simulated stiffness, {source}. {modulus}. A dimension that differs by no more "
        "than the general tolerance ISO 2768-m is not a finding."
    )
