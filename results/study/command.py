"""`flexspline study` and what it writes."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from results.job import DesignFile, Json, Out, answered, folder_of, tell

StudyPath = Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study file.")]


def register(app: typer.Typer) -> None:
    """Add the commands of this room."""
    app.command()(study)
    app.command()(sensitivity)


def study(file: StudyPath, out: Out = None, json: Json = False) -> None:
    """Sweep, optimise or tolerance a design; resumable at any moment."""
    with answered(file):
        from pipeline.study.best import best_field
        from pipeline.study.cluster import check_scheduler, dask_hands
        from pipeline.study.load import load_study
        from pipeline.study.run import ledger_of, nominal_holes, run_study, source_of
        from results.records import as_json
        from results.study.figures import write_figures
        from results.study.progress import Watch
        from results.study.record import summary, words
        from results.study.report import write_study_reports
        from results.study.tables import table_of, write_csv, write_parquet
        from results.study.why import unfollowed

        asked = load_study(file)
        folder = folder_of(file, out)
        run = asked.file.run
        source_of(asked)  # refuse before anything is written
        if run.scheduler and not folder.exists():
            check_scheduler(run.scheduler)
        ledger = ledger_of(asked, folder)
        if keys := unfollowed(asked):
            tell(f"warning: the fast model leaves {keys} out; run.verify solves them")
        if kept := len(ledger.rows()):
            tell(f"{kept} designs are finished already")
        hands = partial(dask_hands, run.workers, run.scheduler)
        holes = nominal_holes(asked, ledger, tell)
        result = run_study(asked, ledger, hands, Watch(asked), say=tell, holes=holes)
        table = table_of(result)
        write_csv(folder / "study.csv", table)
        write_parquet(folder / "study.parquet", table)
        record: dict[str, Any] = summary(result)
        best = best_field(result, tell)
        pictures = write_figures(folder, result, best)
        record["files"] = [str(folder / n) for n in ("study.csv", "study.parquet")]
        reports = write_study_reports(folder, result, pictures, best)
        record["files"] += [str(p) for p in (*pictures, *reports)]
        print(as_json(record) if json else words(result, record))


def sensitivity(design: DesignFile, out: Out = None, json: Json = False) -> None:
    """How K_b and K_e change with every dimension, found in two ways."""
    with answered(design):
        from geometry.load import load_design
        from pipeline.study.sensitivity import sensitivities
        from results.records import as_json
        from results.study.sensitivity import lines, record, write_sensitivity

        gear, folder = load_design(design), folder_of(design, out)
        slopes = sensitivities(gear, tell)
        said = record(gear, slopes)
        write_sensitivity(folder, said)
        print(as_json(said) if json else "\n".join(lines(slopes)))
