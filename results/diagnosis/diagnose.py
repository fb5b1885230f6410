"""What `flexspline diagnose` does: stiffnesses, diagnosis, files, words."""

from __future__ import annotations

from pathlib import Path

from flexspline.pipeline.diagnosis.diagnose import diagnose_file
from flexspline.pipeline.diagnosis.measurement.record import read_measurement
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.stiffness_pair import stiffness_pair
from flexspline.results.diagnosis.console import diagnosis_table
from flexspline.results.diagnosis.files import write_diagnosis
from flexspline.results.diagnosis.record import diagnosis_record
from flexspline.results.records import as_json
from flexspline.results.report.attached import Attachment


def diagnose_and_write(
    context: AnalysisContext,
    measured: Path,
    given: tuple[float | None, float | None],
    folder: Path,
    json: bool,
    attached: tuple[Attachment, ...] = (),
    counts_per_turn: float | None = None,
    gear: bool = False,
) -> str:
    """Diagnose, write all files, and return what is printed; `given` are K_b and K_e, None: FEA.

    `counts_per_turn` of the encoder, where a column is in counts. `gear`: compare with the curve of the whole
    gear, not with the straight line.

    Raises
    ------
    DesignError, ComputationError, MeasurementError
    """
    read_measurement(measured, counts_per_turn)  # refuse a bad file before the long work
    used = stiffness_pair(context, *given)
    chain = None
    if gear:
        from flexspline.pipeline.gear_chain import chain_of

        chain = chain_of(context)
    with context.progress.stage("diagnosis"):
        found = diagnose_file(
            context.design, measured, used.K_b_Nm_per_rad, used.K_e_Nm_per_rad, used.error,
            context if given == (None, None) else None, counts_per_turn, chain, _stated(given),
        )  # fmt: skip
    record = diagnosis_record(found)
    with context.progress.stage("figures and report"):
        write_diagnosis(folder, found, record, used, attached)
    return as_json(record) if json else diagnosis_table(found, folder)


def _stated(given: tuple[float | None, float | None]) -> tuple[str, ...]:
    options = zip(("--Kb", "--Ke"), given, strict=True)
    return tuple(f"{name} {value:g}" for name, value in options if value is not None)
