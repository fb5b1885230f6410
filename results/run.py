"""`flexspline run`: everything is solved, the record is written, then pictures and reports."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flexspline.pipeline.analysis import RunResult, run
from flexspline.pipeline.diagnosis.model.extended_backlash import (
    ExtendedBacklash,
    extended_backlash,
)
from flexspline.pipeline.second_process import second_process
from flexspline.results.gear_words import gear_notes
from flexspline.results.job import Job, kept, put, tell, tell_all
from flexspline.results.pictures import RunDrawings, write_pictures
from flexspline.results.records import Record, extended_record, run_record
from flexspline.results.report.build import write_run_reports
from flexspline.results.report.content import ExtendedSum
from flexspline.results.warned import solved_warnings

if TYPE_CHECKING:
    from flexspline.pipeline.diagnosis.model.model_file import ModelFile


def run_answer(job: Job, measured: ModelFile | None, as_json: bool) -> Record:
    """The keys of docs/contract.md; `measured` adds what its model adds to the backlash.

    Warnings and notes are told as they come. Where the sum's stiffnesses fail, `kept` writes what there is.

    Raises
    ------
    DesignError
    NotFoundError : what the backlash sum needs failed.
    """
    with RunDrawings(job.context) as drawings:
        with kept(job, as_json), second_process():
            result = run(job.context, drawings.add_field, drawings.prepare)
        _tell_all_of(result)
        extended = _extended(result, measured)
        name = measured.path.name if measured is not None else ""
        added = extended_record(extended, name) if extended is not None else {}
        # the answer first: drawing may fail
        put(job.folder, run_record(result, job.wall_s) | added)
        pictures = write_pictures(drawings, result, job.folder, extended)
        for line in pictures.warnings:
            tell(f"warning: {line}")
    total = ExtendedSum(name, extended.total_arcsec) if extended is not None else None
    with job.context.progress.stage("report"):
        write_run_reports(job.folder, result, pictures, total, (job.file,))
    missing = {"pictures_missing": dict(pictures.missing)} if pictures.missing else {}
    return run_record(result, job.wall_s) | added | missing


def _tell_all_of(result: RunResult) -> None:
    tell_all(solved_warnings(result))
    for line in gear_notes(result.gear) if result.gear else ():
        tell(f"note: {line}")


def _extended(result: RunResult, measured: ModelFile | None) -> ExtendedBacklash | None:
    if measured is None:
        return None
    return extended_backlash(result.backlash, measured.model, result.design.load.torque_Nm)
