"""All files of a diagnosis: prepared first, written when all are complete."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from flexspline import __version__
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.model.design_digest import design_digests
from flexspline.pipeline.diagnosis.model.model_file import Provenance
from flexspline.pipeline.diagnosis.model.model_text import model_text
from flexspline.pipeline.stiffness_pair import StiffnessPair
from flexspline.pipeline.temporary_files import scratch_folder
from flexspline.results.atomic import write_together
from flexspline.results.diagnosis.channels import left_out_words
from flexspline.results.diagnosis.record import Record
from flexspline.results.figures.diagnosis.captions import CAPTIONS
from flexspline.results.figures.diagnosis.draw import draw_figures
from flexspline.results.file_names import DIAGNOSIS, EXTENDED_MODEL, PREVIOUS_MODEL, of_diagnosis
from flexspline.results.records import as_json
from flexspline.results.report.attached import Attachment
from flexspline.results.report.both import reports_of
from flexspline.results.report.diagnosis import diagnosis_document


def write_diagnosis(
    folder: Path,
    diagnosis: Diagnosis,
    record: Record,
    used: StiffnessPair,
    attached: tuple[Attachment, ...] = (),
) -> str | None:
    """Write diagnosis.json, the extended model, the figures and the reports into `folder`.

    Nothing is written before all of it is computed; a failure leaves what was there. What an earlier
    diagnosis wrote there and this one has not is taken away, but for the model of another measurement.

    Returns
    -------
    str | None : the note, where another measurement's diagnosis was there.
    """
    other = _other_measurement(folder, record["measurement"])
    made: dict[str, bytes] = {f"{DIAGNOSIS}.json": (as_json(record) + "\n").encode()}
    if diagnosis.model is not None:
        made[EXTENDED_MODEL] = _model(diagnosis, used).encode()
    with scratch_folder("flexspline-diagnosis-") as scratch:
        figures = draw_figures(diagnosis, scratch)
        made |= {f.path.name: f.path.read_bytes() for f in figures}
        document = diagnosis_document(diagnosis, figures, used, attached)
        made |= reports_of(document, {f.path.stem: f.path for f in figures}, name=DIAGNOSIS)
    has_model = other is not None and (folder / EXTENDED_MODEL).exists()
    if has_model:
        made[PREVIOUS_MODEL] = (folder / EXTENDED_MODEL).read_bytes()
    write_together(folder, made)
    for name in set(of_diagnosis(CAPTIONS)) - {*made, PREVIOUS_MODEL}:
        (folder / name).unlink(missing_ok=True)
    if other is None:
        return None
    kept = f"; its model is kept as {PREVIOUS_MODEL}" if has_model else ""
    return f"the earlier diagnosis of {other} in this folder was replaced{kept}; use --out DIR to keep both"


def _other_measurement(folder: Path, measurement: dict[str, Any]) -> str | None:
    """File name of the measurement whose diagnosis is in the folder, where that is another one."""
    try:
        earlier = json.loads((folder / f"{DIAGNOSIS}.json").read_bytes())["measurement"]
        same, name = earlier["sha256"] == measurement["sha256"], str(earlier["file"])
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return None if same else name


def _model(diagnosis: Diagnosis, used: StiffnessPair) -> str:
    assert diagnosis.model is not None
    measurement = diagnosis.measurement
    cycle: dict[str, float] = {}
    time: dict[str, float] = {}
    if isinstance(measurement, Sweep):
        history, names = measurement.history, measurement.units
        if measurement.cycles_recorded:
            cycle = {u: c[0] for u, c in zip(names, measurement.cycles, strict=True)}
        if history.time_s is not None:
            first = [float(history.time_s[rows[0]]) for rows in history.unit_slices]
            time = dict(zip(names, first, strict=True))
    provenance = Provenance(
        program=f"flexspline {__version__}",
        design=diagnosis.design.name,
        measurement=measurement.path.name,
        measurement_sha256=measurement.read_as.sha256,
        verdict=diagnosis.outcome.verdict,
        K_b_Nm_per_rad=used.K_b_Nm_per_rad,
        K_e_Nm_per_rad=used.K_e_Nm_per_rad,
        time_recorded=bool(time) or not isinstance(measurement, Sweep),
        first_cycle=cycle,
        first_time_s=time,
        design_digests=design_digests(diagnosis.design),
    )
    outcome, sweep = diagnosis.outcome, diagnosis.sweep
    doubt = sweep.doubt if sweep is not None else None
    held_out = "" if outcome.gain is None else left_out_words(outcome.gain.held_out)
    causes = outcome.causes if sweep is None else sweep.causes
    return model_text(diagnosis.model, provenance, causes, outcome.gain, doubt, held_out)
