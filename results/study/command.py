"""`flexspline study` and what it writes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from flexspline.results.file_names import SENSITIVITY, STUDY
from flexspline.results.job import RESUMES, answered, tell
from flexspline.results.options import DesignFile, Json, Out
from flexspline.results.streams import show
from flexspline.results.usage import named_file

StudyPath = Annotated[
    Path, typer.Argument(metavar="STUDY.toml", parser=named_file, help="The study file.")
]

NO_PARQUET = 'no study.parquet beside study.csv: pip install "flexspline[parquet]" for that'


def study(file: StudyPath, out: Out = None, json: Json = False) -> None:
    """Sweep, optimisation or tolerance analysis; can be resumed."""
    with answered(file, RESUMES):
        from flexspline.geometry.errors import ComputationError
        from flexspline.geometry.load import read_raw, tables_from
        from flexspline.pipeline.study.best import best_field
        from flexspline.pipeline.study.cluster import check_scheduler
        from flexspline.pipeline.study.drive import within
        from flexspline.pipeline.study.load import study_from
        from flexspline.pipeline.study.run import source_of, trial_store_of, whole_study
        from flexspline.results.output_folder import folder_of
        from flexspline.results.records import as_json
        from flexspline.results.report.attached import Attachment
        from flexspline.results.study.best_design import best_warnings, write_best_design
        from flexspline.results.study.best_stress import draw_best_stress
        from flexspline.results.study.failures import nothing_built
        from flexspline.results.study.figures import write_figures
        from flexspline.results.study.notes import (
            border_warnings,
            preloaded,
            unsettled,
            wide_bounds,
        )
        from flexspline.results.study.progress import Watch
        from flexspline.results.study.record import summary, words
        from flexspline.results.study.report import write_study_reports
        from flexspline.results.study.tables import table_of, write_csv, write_parquet
        from flexspline.results.study.why import unfollowed

        raw = read_raw(file, "study")
        asked = study_from(tables_from(raw, file, "study"), file.parent, file.stem)
        base = file.parent / asked.file.design
        attached = (
            Attachment(file.name, raw, "Study file"),
            Attachment(base.name, read_raw(base), "Design file"),
        )
        folder = folder_of(file, out, STUDY, shared=True)
        run = asked.file.run
        size = source_of(asked).size  # refuse before anything is written
        if run.scheduler and not any(folder.iterdir()):
            check_scheduler(run.scheduler)
        if run.method == "grid" and size != run.evaluations:
            tell(f"the grid has {size} designs (run.evaluations = {run.evaluations})")
        store = trial_store_of(asked, folder)
        if keys := unfollowed(asked):
            tell(f"warning: the fast model leaves {keys} out; run.verify solves them")
        if kept := len(within(store.rows(), size)):
            tell(f"{kept} designs are finished already")
        result = whole_study(asked, store, Watch(asked), tell)
        of_best = tuple(best_warnings(result))
        of_all = (unsettled, wide_bounds, border_warnings, preloaded)
        for line in (*(line for each in of_all for line in each(result)), *of_best):
            tell(f"warning: {line}")
        table = table_of(result)
        write_csv(folder / "study.csv", table)
        tables = [folder / "study.csv"]
        if write_parquet(folder / "study.parquet", table):
            tables.append(folder / "study.parquet")
        else:
            tell(NO_PARQUET)
        record: dict[str, Any] = summary(result)
        shown = best_field(result, tell) if len(result.built) > 1 else None
        best = draw_best_stress(folder, shown)
        if best.missing:
            record["pictures_missing"] = {"best_stress": best.missing}
            tell(
                f"warning: not drawn: {(best.picture and '3-D view ') or ''}best_stress: {best.missing}"
            )
        pictures = write_figures(folder, result, best.picture)
        if best_file := write_best_design(folder, result):
            tables.append(best_file)
        record["files"] = [str(p) for p in tables]
        reports = write_study_reports(folder, result, pictures, best, attached, of_best)
        record["files"] += [str(p) for p in (*pictures, *reports)]
        show(as_json(record) if json else words(result, record), json)
        if nothing := nothing_built(result):
            raise ComputationError(nothing)


def sensitivity(design: DesignFile, out: Out = None, json: Json = False) -> None:
    """Derivatives of K_b, K_e and backlash by every dimension."""
    with answered(design):
        from flexspline.geometry.load import load_design
        from flexspline.pipeline.study.sensitivity import sensitivities
        from flexspline.results.output_folder import folder_of
        from flexspline.results.records import as_json
        from flexspline.results.study.sensitivity import lines, record, write_sensitivity

        gear, folder = load_design(design), folder_of(design, out, (SENSITIVITY,))
        slopes = sensitivities(gear, tell)
        said = record(gear, slopes)
        write_sensitivity(folder, said)
        show(as_json(said) if json else "\n".join(lines(gear, slopes)), json)
