"""The reports of a run: typed results into the report's content."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from pipeline.chain import RunResult
from pipeline.parts import Workshop
from results.atomic import write_bytes
from results.pictures import small, turning_views
from results.records import program_version
from results.report.content import Pictures, ReportContent
from results.report.page import page_of, png
from results.report.sections import run_document
from results.report.versions import library_versions
from results.report.write import pictures_of, write_report

RENDERED = (
    "flexspline_stress", "shaft_stress", "wave_generator", "flexspline_mesh", "shaft_mesh",
)  # fmt: skip
"""Pictures that are large as PNG."""


def write_run_report(
    path: Path, result: RunResult, pictures: Mapping[str, Path], extended_model: str = ""
) -> None:
    """`report.pdf` of `flexspline run`; `pictures` as `results.pictures` names them."""
    write_report(path, _content(result, pictures, extended_model))


def write_run_page(
    path: Path,
    shop: Workshop,
    result: RunResult,
    pictures: Mapping[str, Path],
    extended_model: str = "",
) -> None:
    """`report.html` of `flexspline run`: the same content, with 3-D views, in one file.

    Views and shrunk pictures are kept in the workshop's cache.
    """
    content = _content(result, pictures, extended_model)
    images = {}
    for name, source in pictures_of(content).items():
        image = png(source)
        images[name] = replace(image, data=small(shop, source)) if name in RENDERED else image
    views = turning_views(shop, result)
    with shop.progress.stage("report.html"):
        write_bytes(path, page_of(run_document(content), images, views))


def _content(result: RunResult, pictures: Mapping[str, Path], extended_model: str) -> ReportContent:
    found, fields, design = result.stiffnesses, result.fields, result.design
    return ReportContent(
        design=design,
        version=program_version(),
        K_b=found.flexspline,
        K_e=found.shaft,
        K_series_Nm_per_rad=found.series_Nm_per_rad(design),
        backlash=result.backlash,
        pictures=Pictures(
            budget=pictures["backlash_budget"],
            torque_angle=pictures["torque_angle"],
            flexspline_stress=pictures["flexspline_torque"],
            shaft_stress=pictures["shaft_torque"],
            wave_generator=pictures["wave_generator"],
            flexspline_mesh=pictures["flexspline_mesh"],
            shaft_mesh=pictures["shaft_mesh"],
            convergence=pictures["convergence"],
        ),
        K_b_lobes=found.K_b_lobes,
        K_b_lobes_contact=found.K_b_lobes_contact,
        K_b_lobes_unsupported=found.K_b_lobes_unsupported,
        flexspline_peak=fields["flexspline_torque"].peak,
        shaft_peak=fields["shaft_torque"].peak,
        wave_generator_peak=fields["wave_generator"].peak,
        ring=found.ring,
        warnings=result.warnings,
        stage_seconds=result.stage_seconds,
        versions=library_versions(),
        extended_model=extended_model,
    )
