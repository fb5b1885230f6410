"""Steps of `flexspline study`: evaluate, warn, and write tables, pictures and reports."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from flexspline.pipeline.study.best import best_field
from flexspline.pipeline.study.cluster import check_scheduler
from flexspline.pipeline.study.drive import StudyListener, within
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.run import source_of, trial_store_of, whole_study
from flexspline.pipeline.study.study import Study
from flexspline.results.job import tell, tell_all
from flexspline.results.report.attached import Attachment
from flexspline.results.study.best_design import write_best_design
from flexspline.results.study.best_stress import BestStress, draw_best_stress
from flexspline.results.study.design_warnings import design_warnings
from flexspline.results.study.figures import write_figures
from flexspline.results.study.notes import (
    border_warnings,
    preloaded,
    unmoved,
    unsettled,
    wide_bounds,
)
from flexspline.results.study.progress import Watch
from flexspline.results.study.record import summary
from flexspline.results.study.report import write_study_reports
from flexspline.results.study.tables import table_of, write_csv, write_parquet
from flexspline.results.study.why import unfollowed

NO_PARQUET = 'study.parquet is not written; to get it: pip install "flexspline[parquet]"'


def evaluated(study: Study, folder: Path) -> StudyResult:
    """All its designs; those that `folder` has already are not solved again."""
    run, size = study.file.run, source_of(study).size  # refuse before anything is written
    if run.scheduler and not any(folder.iterdir()):
        check_scheduler(run.scheduler)
    if run.method == "grid" and size != run.evaluations:
        tell(f"the grid has {size} designs (run.evaluations = {run.evaluations})")
    store = trial_store_of(study, folder)
    if keys := unfollowed(study):
        tell(f"warning: the fast model ignores {keys}; run.verify solves them")
    if kept := len(within(store.rows(), size)):
        tell(f"{kept} designs are already finished")
    return whole_study(study, store, StudyListener(Watch(study), tell))


def study_answer(
    result: StudyResult, folder: Path, attached: tuple[Attachment, ...]
) -> dict[str, Any]:
    """The keys of docs/contract.md; warnings are told, and all files of `folder` are written."""
    of_designs = tuple(design_warnings(result))
    tell_all(
        (*unsettled(result), *unmoved(result), *wide_bounds(result), *border_warnings(result),
         *preloaded(result), *of_designs)
    )  # fmt: skip
    tables = _write_tables(folder, result)
    record: dict[str, Any] = summary(result)
    best = _draw_best(folder, result)
    if best.missing:
        record["pictures_missing"] = {"best_stress": best.missing}
    pictures = write_figures(folder, result, best.picture)
    if best_file := write_best_design(folder, result):
        tables.append(best_file)
    reports = write_study_reports(folder, result, pictures, best, attached, of_designs)
    record["files"] = [str(path) for path in (*tables, *pictures, *reports)]
    return record


def _write_tables(folder: Path, result: StudyResult) -> list[Path]:
    """CSV, and parquet where its package is there."""
    csv, parquet = folder / "study.csv", folder / "study.parquet"
    table = table_of(result)
    write_csv(csv, table)
    if write_parquet(parquet, table):
        return [csv, parquet]
    tell(NO_PARQUET)
    return [csv]


def _draw_best(folder: Path, result: StudyResult) -> BestStress:
    """The best design's stress on the wave generator, where there is more than one to be the best of."""
    shown = best_field(result, tell) if len(result.built) > 1 else None
    best = draw_best_stress(folder, shown)
    if best.missing:
        view = "3-D view " if best.picture else ""
        tell(f"warning: not drawn: {view}best_stress: {best.missing}")
    return best
