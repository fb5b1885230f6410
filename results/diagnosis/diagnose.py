"""Steps of `flexspline diagnose`: stiffnesses, diagnosis, files, text."""

from __future__ import annotations

from pathlib import Path

from flexspline.geometry.errors import FlexsplineError
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.with_stiffness import (
    DiagnosisOptions,
    GivenStiffness,
    diagnose_with_stiffness,
)
from flexspline.results.diagnosis.console import diagnosis_table
from flexspline.results.diagnosis.files import write_diagnosis
from flexspline.results.diagnosis.record import diagnosis_record
from flexspline.results.diagnosis.summary import summary, verdict_heading
from flexspline.results.job import Job, tell
from flexspline.results.records import as_json


class UnwrittenError(FlexsplineError, OSError):
    """A diagnosis that is known and could not be written: which file, why, and the verdict, on one line."""

    def __init__(self, fault: OSError, diagnosis: Diagnosis, folder: Path) -> None:
        verdict = f"{verdict_heading(diagnosis)} ({diagnosis.verdict}). {summary(diagnosis)}"
        why = f"{fault.strerror or fault}; no file was written. The verdict: {verdict}"
        super().__init__(fault.errno, why, fault.filename or str(folder))


def diagnose_and_write(
    job: Job,
    measured: Path,
    given: tuple[float | None, float | None],
    json: bool,
    counts_per_turn: float | None = None,
    gear: bool = False,
) -> str:
    """Diagnose, write all files, and return what is printed; `given` are K_b and K_e, None: FEA.

    `counts_per_turn` of the encoder, where a column is in counts. `gear`: compare with the curve of the whole
    gear, not with the straight line. Where both K are given no solver is loaded.

    Raises
    ------
    DesignError, ComputationError, MeasurementError
    UnwrittenError : the files could not be written, on a full disk; it says the verdict.
    """
    diagnosis, used = diagnose_with_stiffness(
        job.design,
        measured,
        GivenStiffness(given, ("--Kb ", "--Ke ")),
        lambda: job.context,
        DiagnosisOptions(counts_per_turn, gear),
        job.progress,
    )
    record = diagnosis_record(diagnosis)
    with job.progress.stage("figures and report"):
        try:
            note = write_diagnosis(job.folder, diagnosis, record, used, (job.file,))
        except OSError as fault:
            raise UnwrittenError(fault, diagnosis, job.folder) from fault
    if note is not None:
        tell(f"note: {note}")
    return as_json(record) if json else diagnosis_table(diagnosis, job.folder)
