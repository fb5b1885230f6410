"""`flexspline study` and what it writes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from flexspline.results.file_names import SENSITIVITY, STUDY
from flexspline.results.job import RESUMES, answered, tell, tell_all
from flexspline.results.options import DesignFile, Json, Out
from flexspline.results.streams import show
from flexspline.results.usage import named_file

if TYPE_CHECKING:
    from flexspline.pipeline.study.study import Study
    from flexspline.results.report.attached import Attachment

StudyPath = Annotated[
    Path, typer.Argument(metavar="STUDY.toml", parser=named_file, help="The study file.")
]


def study(file: StudyPath, out: Out = None, json: Json = False) -> None:
    """Sweep, optimisation or tolerance analysis; can be resumed."""
    with answered(file, RESUMES):
        from flexspline.geometry.errors import ComputationError
        from flexspline.results.output_folder import folder_of
        from flexspline.results.records import as_json
        from flexspline.results.study.answer import evaluated, study_answer
        from flexspline.results.study.failures import contradiction, nothing_built
        from flexspline.results.study.record import words

        task, attached = _read(file)
        folder = folder_of(file, out, STUDY, shared=True)
        result = evaluated(task, folder)
        record = study_answer(result, folder, attached)
        show(as_json(record) if json else words(result, record), json)
        if failed := contradiction(result) or nothing_built(result):
            raise ComputationError(failed)


def _read(file: Path) -> tuple[Study, tuple[Attachment, ...]]:
    """The study, and both of its files for the reports."""
    from flexspline.geometry.load import read_raw, tables_from
    from flexspline.pipeline.study.load import study_from
    from flexspline.results.report.attached import Attachment

    raw = read_raw(file, "study")
    loaded = study_from(tables_from(raw, file, "study"), file.parent, file.stem)
    base = file.parent / loaded.file.design
    return loaded, (
        Attachment(file.name, raw, "Study file"),
        Attachment(base.name, read_raw(base), "Design file"),
    )


def sensitivity(design: DesignFile, out: Out = None, json: Json = False) -> None:
    """Derivatives of K_b, K_e and backlash by every dimension."""
    with answered(design):
        from flexspline.geometry.load import load_design
        from flexspline.pipeline.study.sensitivity import sensitivities
        from flexspline.results.atomic import write_bytes
        from flexspline.results.output_folder import folder_of
        from flexspline.results.records import as_json
        from flexspline.results.study.sensitivity import lines, record

        gear, folder = load_design(design), folder_of(design, out, (SENSITIVITY,))
        slopes = sensitivities(gear, tell)
        content = record(gear, slopes)
        tell_all(content["warnings"])
        write_bytes(folder / SENSITIVITY, (as_json(content) + "\n").encode())
        show(as_json(content) if json else "\n".join(lines(gear, slopes)), json)
