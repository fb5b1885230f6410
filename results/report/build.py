"""The reports of a run: typed results into the report's content."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from flexspline import __version__
from flexspline.pipeline.analysis import RunResult
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.two_threads import beside
from flexspline.results.atomic import write_bytes
from flexspline.results.file_names import REPORT
from flexspline.results.pictures import RunPictures
from flexspline.results.report.attached import Attachment
from flexspline.results.report.content import ExtendedSum, ReportContent
from flexspline.results.report.page import page_of, png
from flexspline.results.report.sections import run_document
from flexspline.results.report.versions import library_versions
from flexspline.results.report.write import write_report
from flexspline.results.warned import all_warnings


def write_run_reports(
    folder: Path,
    context: AnalysisContext,
    result: RunResult,
    pictures: RunPictures,
    extended: ExtendedSum | None = None,
    attached: tuple[Attachment, ...] = (),
) -> None:
    """`report.pdf` and `report.html`, at once: typst needs no Python.

    Raises
    ------
    ReportError, OSError : as of each.
    """
    told = result, pictures, extended, attached

    def page() -> None:
        write_run_page(folder / f"{REPORT}.html", *told)

    with context.progress.stage("report"), beside(context.progress, [page]) as rest:
        write_run_report(folder / f"{REPORT}.pdf", *told)
        rest()


def write_run_report(
    path: Path,
    result: RunResult,
    pictures: RunPictures,
    extended: ExtendedSum | None = None,
    attached: tuple[Attachment, ...] = (),
) -> None:
    """`report.pdf` of `flexspline run`."""
    write_report(path, report_content(result, pictures, extended, attached))


def write_run_page(
    path: Path,
    result: RunResult,
    pictures: RunPictures,
    extended: ExtendedSum | None = None,
    attached: tuple[Attachment, ...] = (),
) -> None:
    """`report.html` of `flexspline run`: the same content, with 3-D views, in one file."""
    content = report_content(result, pictures, extended, attached)
    images = {}
    for name, source in content.pictures.items():
        image = png(source)
        images[name] = replace(image, data=pictures.small.get(name, image.data))
    write_bytes(path, page_of(run_document(content), images, pictures.views))


def report_content(
    result: RunResult,
    pictures: RunPictures,
    extended: ExtendedSum | None,
    attached: tuple[Attachment, ...],
) -> ReportContent:
    """What a run's report says, before any layout."""
    found, design = result.stiffnesses, result.design
    peaks = {name: solved.peak for name, solved in result.fields.items()}
    return ReportContent(
        design=design,
        version=__version__,
        stiffnesses=found.solved,
        K_series_Nm_per_rad=found.series_Nm_per_rad(design),
        backlash=result.backlash,
        pictures=pictures.paths,
        missing_pictures=pictures.missing,
        flexspline_peak=peaks.get("flexspline_torque"),
        shaft_peak=peaks.get("shaft_torque"),
        wave_generator_peak=peaks.get("wave_generator", found.wave_generator_peak),
        half_seat_peak=found.half_seat_peak,
        linear_limit=result.linear_limit,
        ring=found.ring,
        gear=result.gear,
        gear_missing=str(found.missing.get("gear", "")),
        warnings=all_warnings(result),
        stage_seconds=result.stage_seconds,
        versions=library_versions(),
        extended=extended,
        attached=attached,
    )
