"""What `flexspline diagnose` does: stiffnesses, diagnosis, files, words."""

from __future__ import annotations

from pathlib import Path

from flexspline.pipeline.diagnosis.diagnose import diagnose_file
from flexspline.pipeline.diagnosis.measurement.record import read_measurement
from flexspline.pipeline.stiffness_pair import given_pair, stiffness_pair
from flexspline.results.diagnosis.console import diagnosis_table
from flexspline.results.diagnosis.files import write_diagnosis
from flexspline.results.diagnosis.record import diagnosis_record
from flexspline.results.job import Job
from flexspline.results.records import as_json


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
    """
    read_measurement(measured, counts_per_turn)  # refuse a bad file before the long work
    stated = _stated(given)
    used = given_pair(*given) or stiffness_pair(job.context, *given)
    chain = None
    if gear:
        from flexspline.pipeline.gear_chain import chain_of

        chain = chain_of(job.context)
    with job.progress.stage("diagnosis"):
        found = diagnose_file(
            job.design, measured, used.K_b_Nm_per_rad, used.K_e_Nm_per_rad, used.error,
            None if stated else job.context, counts_per_turn, chain, stated,
        )  # fmt: skip
    record = diagnosis_record(found)
    with job.progress.stage("figures and report"):
        write_diagnosis(job.folder, found, record, used, (job.file,))
    return as_json(record) if json else diagnosis_table(found, job.folder)


def _stated(given: tuple[float | None, float | None]) -> tuple[str, ...]:
    options = zip(("--Kb", "--Ke"), given, strict=True)
    return tuple(f"{name} {value:g}" for name, value in options if value is not None)
