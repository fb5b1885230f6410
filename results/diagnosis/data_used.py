"""The data used from a record and its calibration, in words and as JSON."""

from __future__ import annotations

from typing import Any

from flexspline.geometry.listed import joined
from flexspline.pipeline.diagnosis.calibration import FAR_DEVIATIONS, Calibration, Estimate
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.clearance_offset import CLEARANCE
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.slope_hints import SlopeRatio, slope_off
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep
from flexspline.pipeline.diagnosis.sweep.row_selection import RowCounts
from flexspline.results.diagnosis.reading import columns_record, form_record
from flexspline.results.diagnosis.slope_words import slope_times
from flexspline.results.diagnosis.words import plus_minus, title_of
from flexspline.results.numbers import grouped, signed

AS_SIMULATED = 0.8
"""Share of the simulated deviation: a record that leaves more adds at most about half of the information that
the simulation has."""
AS_SIMULATED_WITHIN = 0.5
"""Stated deviations from the simulated value, within which a value is said to be as simulated."""

NOT_NARROWED = "this record does not reduce the uncertainty"
"""Remark on a value that the record determines no better than the simulation."""
AT_REVERSALS, BEFORE_FIRST = "at reversals", "before the first reversal"
"""Rows that were not used."""
SHORTENED = "values"
"""What a long record is averaged to; some of them are single rows, so not all are means."""


def data_record(diagnosis: Diagnosis) -> dict[str, Any]:
    """The file with its hash, how it was read, rows by their use, and the calibration.

    What was not computed is absent.
    """
    measurement = diagnosis.measurement
    read_as = measurement.read_as
    record: dict[str, Any] = {
        "measurement": {"file": measurement.path.name, "sha256": read_as.sha256},
        "file_format": form_record(read_as),
        "read_as": columns_record(read_as),
    }
    if diagnosis.sweep is not None and isinstance(measurement, Sweep):
        record["rows"] = _rows(diagnosis.sweep.explained.prepared, len(measurement))
    if diagnosis.calibration is not None:
        record["calibrated"] = _calibrated(diagnosis.calibration)
    return record


def _rows(prepared: PreparedSweep, rows: int) -> dict[str, Any]:
    """By their use; `rows` of all units, of which `prepared` may be one."""
    counts, averaging = prepared.row_counts, prepared.sweep.averaging
    wrong, held = sum(w.rows_left_out for w in prepared.sweep.wrong), prepared.sweep.held_rows
    lost = 0 if prepared.sweep.lost is None else len(prepared.sweep.lost.lines)
    measured = counts.total if averaging is None else averaging.rows_read
    others = rows - measured
    record: dict[str, Any] = {"read": rows + wrong + held + lost}
    if averaging is not None:
        record |= {"averaged": averaging.rows_averaged, "means": counts.total}
    return record | {
        "used": counts.used,
        "left_out": {
            "backlash_crossing": counts.crossing,
            "torque_reversal": counts.turning,
            "before_first_reversal": counts.settling,
            "outlier": counts.outliers + wrong,
            **({"held_reading": held} if held else {}),
            **({"lost_reading": lost} if lost else {}),
            **({"other_units": others} if others else {}),
        },
    }


def _calibrated(calibration: Calibration) -> dict[str, float]:
    gap, compliance = calibration.gap_arcsec, calibration.compliance
    record = {"gap_arcsec": gap.value, "gap_std_arcsec": gap.std}
    if compliance is not None:
        record |= {
            "compliance_arcsec_per_Nm": compliance.value,
            "compliance_std_arcsec_per_Nm": compliance.std,
        }
    return record


def calibrated_sentences(
    calibration: Calibration,
    prediction: Prediction,
    outcome: DiagnosisOutcome,
    slope: SlopeRatio | None = None,
) -> str:
    """Gap and compliance as fitted to the record, each with the simulated one, and what else moves them.

    `slope`: the record's own, where it is surely another than simulated (`slope_off`).
    """
    moved = any(c.id == CLEARANCE for c in outcome.causes)
    gap = _against(
        calibration.gap_arcsec,
        prediction.gap_arcsec,
        prediction.gap_std_arcsec,
        f"the difference counts as {title_of(CLEARANCE)}" if moved else NOT_NARROWED,
    )
    parts = [f"gap {gap} arcsec"]
    if calibration.compliance is not None:
        measured = calibration.compliance
        if slope is not None and _is_held(measured, prediction, slope):
            compliance = _held(measured, prediction, slope)
        else:
            compliance = _against(measured, prediction.compliance, prediction.compliance_std)
        parts.append(f"compliance {compliance} arcsec per N·m")
    found_any = outcome.causes or outcome.unexplained
    beside = ", without the other effects" if calibration.beside_effects and found_any else ""
    text = f"Calibrated on this record{beside}: {'; '.join(parts)}."
    known = known_causes()
    elastic = [c for c in outcome.causes if c.id in known and known[c.id].elastic]
    if elastic and calibration.compliance is not None:
        titles = joined((title_of(c.id, c.magnitude) for c in elastic), "and")
        text += f" The measured slope is the sum of this compliance and the effect of: {titles}."
    if calibration.gap_arcsec.value < 0:
        text += " A gap cannot be negative: the model does not describe this record, or a reading is wrong."
    if outcome.unexplained:
        text += " An unexplained effect may have changed these values by more than the stated ±."
    return text


def own_slope(diagnosis: Diagnosis) -> SlopeRatio | None:
    """Of a sweep, where it is surely not the simulated one."""
    sweep = diagnosis.measurement
    return slope_off(sweep, diagnosis.prediction) if isinstance(sweep, Sweep) else None


def _is_held(measured: Estimate, prediction: Prediction, slope: SlopeRatio) -> bool:
    """Whether a compliance lies nearer to the simulated one than to the record's own slope."""
    return 2 * abs(measured.value / prediction.compliance - 1) < abs(slope.ratio - 1)


def _held(measured: Estimate, prediction: Prediction, slope: SlopeRatio) -> str:
    return (
        f"{plus_minus(measured.value, measured.std)} (held near the simulated "
        f"{plus_minus(prediction.compliance, prediction.compliance_std)}; the record itself is "
        f"{slope_times(slope)}: a straight line through the record has a slope of "
        f"{slope.ratio * prediction.compliance:.3g}. The difference counts as an effect)"
    )


def _against(measured: Estimate, simulated: float, std: float, as_open: str = NOT_NARROWED) -> str:
    """A value beside the simulated one; `as_open` is said where the record leaves it as open."""
    text = plus_minus(measured.value, measured.std)
    if not std:
        return f"{text} (simulated {simulated:.4g})"
    if measured.std > AS_SIMULATED * std:  # another effect may take its place
        if abs(measured.value - simulated) < AS_SIMULATED_WITHIN * std:
            return f"{text} (as simulated: {as_open})"
        if abs(measured.value - simulated) < FAR_DEVIATIONS * min(measured.std, std):
            return f"{text} (simulated {plus_minus(simulated, std)}; {as_open})"
    off = signed((measured.value - simulated) / std, 1)
    return f"{text} (simulated {plus_minus(simulated, std)}, {off} standard deviations)"


def rows_used(prepared: PreparedSweep) -> str:
    """How many of the rows identify causes."""
    counts, averaging = prepared.row_counts, prepared.sweep.averaging
    words = f"{grouped(counts.used, 0)} of {grouped(counts.total, 0)}"
    return words if averaging is None else f"{words} {SHORTENED}"


def kinds_left_out(counts: RowCounts) -> list[tuple[str, int]]:
    """Short words for each kind of row that is there and was not used, with how many."""
    kinds = (
        ("gap crossed", counts.crossing),
        (AT_REVERSALS, counts.turning),
        (BEFORE_FIRST, counts.settling),
        (f"outlier{'s' * (counts.outliers != 1)}", counts.outliers),
    )
    return [(words, count) for words, count in kinds if count]


def row_notes(prepared: PreparedSweep) -> list[str]:
    """Rows used, and rows left out by their reason."""
    counts, averaging = prepared.row_counts, prepared.sweep.averaging
    notes = []
    if averaging is not None:
        left = averaging.rows_read - averaging.rows_averaged
        notes.append(
            f"{grouped(averaging.rows_read, 0)} rows were read and averaged to "
            f"{grouped(counts.total, 0)} {SHORTENED}: means of neighbouring rows, and single rows where "
            f"backlash is crossed and at corners of the torque; {grouped(left, 0)} rows (spikes, surplus "
            "cycles) were left out"
        )
    what = "rows" if averaging is None else SHORTENED
    notes.append(
        f"{rows_used(prepared)}{' rows' * (averaging is None)} were used for identification"
    )
    others = ", ".join(
        f"{grouped(count, 0)} {words}"
        for count, words in (
            (counts.turning, f"{AT_REVERSALS} of torque"),
            (counts.settling, f"{BEFORE_FIRST} at high torque"),
            (counts.outliers, f"isolated outlier{'s' * (counts.outliers != 1)}"),
        )
        if count
    )
    if counts.crossing:
        crossing = f"{grouped(counts.crossing, 0)} {what} {_at_the_crossing(prepared)}"
        notes.append(
            f"{crossing} (backlash crossing) were not used for identification"
            + (f"; also not used: {others}" if others else "")
        )
    elif others:
        notes.append(f"{what} not used for identification: {others}")
    return notes


def _at_the_crossing(prepared: PreparedSweep) -> str:
    """Which rows those are: the teeth's torque counts, which is not what was read."""
    band = f"{prepared.band_Nm:.3g} N·m"
    if prepared.ahead is not None:
        return (
            f"where the torque at the teeth is less than {band} because of friction ahead of them"
        )
    if prepared.offset_Nm:
        return f"within {band} of the shifted zero of torque"
    return f"with |T| < {band}"
