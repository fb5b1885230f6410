"""The reports of a run: typed results into the report's content."""

from __future__ import annotations

from pathlib import Path

from flexspline import __version__
from flexspline.pipeline.analysis import RunResult
from flexspline.results.atomic import write_together
from flexspline.results.pictures import RunPictures
from flexspline.results.report.attached import Attachment
from flexspline.results.report.both import reports_of
from flexspline.results.report.content import ExtendedSum, ReportContent
from flexspline.results.report.sections import run_document
from flexspline.results.report.versions import library_versions
from flexspline.results.warned import all_warnings


def write_run_reports(
    folder: Path,
    result: RunResult,
    pictures: RunPictures,
    extended: ExtendedSum | None = None,
    attached: tuple[Attachment, ...] = (),
) -> None:
    """`report.pdf` and `report.html` of `flexspline run`.

    Raises
    ------
    ReportError, OSError
    """
    document = run_document(report_content(result, pictures, extended, attached))
    made = reports_of(document, pictures.paths, pictures.views, smaller=pictures.small)
    write_together(folder, made)


def report_content(
    result: RunResult,
    pictures: RunPictures,
    extended: ExtendedSum | None,
    attached: tuple[Attachment, ...],
) -> ReportContent:
    """What a run's report says, before any layout."""
    stiffnesses = result.stiffnesses
    peaks = {name: solved.peak for name, solved in result.fields.items()}
    return ReportContent(
        design=result.design,
        version=__version__,
        stiffnesses=stiffnesses,
        backlash=result.backlash,
        pictures=pictures.paths,
        missing_pictures=pictures.missing,
        flexspline_peak=peaks.get("flexspline_torque"),
        shaft_peak=peaks.get("shaft_torque"),
        wave_generator_peak=peaks.get("wave_generator", stiffnesses.wave_generator_peak),
        linear_limit=result.linear_limit,
        gear=result.gear,
        warnings=all_warnings(result),
        stage_seconds=result.stage_seconds,
        versions=library_versions(),
        extended=extended,
        attached=attached,
    )
