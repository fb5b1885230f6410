"""diagnosis.json: the keys of docs/contract.md."""

from __future__ import annotations

from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.outcome import Gain, NamedCause
from flexspline.pipeline.diagnosis.sweep.separate_units import UnitsApart
from flexspline.results.diagnosis.advice import why
from flexspline.results.diagnosis.channels import left_out_words
from flexspline.results.diagnosis.data_used import data_record
from flexspline.results.diagnosis.gear_inputs import gear_inputs_record
from flexspline.results.diagnosis.notes import notes
from flexspline.results.diagnosis.structure_words import structure_words
from flexspline.results.diagnosis.summary import summary, verdict_heading
from flexspline.results.diagnosis.words import cause_title, magnitude_words, sure_words
from flexspline.results.file_names import EXTENDED_MODEL
from flexspline.results.records import Record, heading


def diagnosis_record(diagnosis: Diagnosis) -> Record:
    """The diagnosis as JSON; what was not found is absent."""
    outcome = diagnosis.outcome
    record: Record = {
        **heading(diagnosis.design),
        "verdict": outcome.verdict,
        "heading": verdict_heading(diagnosis),
        "summary": summary(diagnosis),
        "against": "sum" if diagnosis.prediction.bend is None else "gear",
        **data_record(diagnosis),
        "causes": [_cause(c) for c in outcome.causes],
        "unexplained": [
            {
                "channel": u.channel,
                "rms": u.rms,
                "unit": u.unit,
                "p_value": u.p_value,
                "what": structure_words(u),
            }
            for u in outcome.unexplained
        ],
        "notes": list(notes(diagnosis)),
    }
    if diagnosis.sweep is not None and diagnosis.sweep.apart is not None:
        record |= _by_unit(diagnosis.sweep.apart)
    if outcome.gain is not None:
        record["gain"] = _gain(outcome.gain)
    if outcome.gains_at_levels:
        record["gain_at_levels"] = [
            {"channel": g.channel, **_gain(g)} for g in outcome.gains_at_levels
        ]
    if diagnosis.gear_inputs is not None:
        record["gear_inputs"] = gear_inputs_record(diagnosis.gear_inputs)
    if diagnosis.model is not None:
        record["extended_model"] = EXTENDED_MODEL
    if outcome.next_measurement is not None:
        after = outcome.next_measurement
        record["next_measurement"] = {
            "vary": after.vary,
            "why": why(after, diagnosis.kind, diagnosis.causes),
        }
    return record


def _by_unit(separate: UnitsApart) -> Record:
    """Verdict and causes of each unit that was diagnosed by itself, and the one that the rest is of."""
    units = [
        {
            "unit": name,
            "verdict": "insufficient" if decision is None else decision.verdict,
            "causes": [_cause(c) for c in decision.causes] if decision else [],
        }
        for name, decision in separate.decisions.items()
    ]
    return {"unit_shown": separate.unit, "by_unit": units}


def _cause(cause: NamedCause) -> Record:
    record: Record = {
        "id": cause.id,
        "title": cause_title(cause),
        "size": magnitude_words(cause),
        "confidence": sure_words(cause),
        "probability": cause.probability,
        "alternatives": list(cause.alternatives),
        "magnitude": cause.magnitude,
        "magnitude_std": cause.magnitude_std,
        "unit": cause.unit,
        "evidence_nats": cause.evidence_nats,
        "rms_arcsec": cause.rms_arcsec,
    }
    if cause.own_units:
        record["units"] = list(cause.own_units)
    if cause.ahead_Nm:
        record["ahead_of_gap_Nm"] = cause.ahead_Nm
        record["ahead_of_gap_std_Nm"] = cause.ahead_std_Nm
    if cause.widest_arcsec is not None:
        record["widest_loop_arcsec"] = cause.widest_arcsec
    return record


def _gain(gain: Gain) -> Record:
    return {
        "held_out": left_out_words(gain.held_out),
        "rmse_before": gain.rmse_before,
        "rmse_calibrated": gain.rmse_calibrated,
        "rmse_after": gain.rmse_after,
        "noise_floor": gain.noise_floor,
        "unit": gain.unit,
        "held_out_rows": list(gain.held_out_rows),
    }
