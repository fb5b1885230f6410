"""The first design of a study, solved like its rows: the reference for the best designs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict

from flexspline.pipeline.study.evaluate import Outcome, Task, evaluate, outcome_of
from flexspline.pipeline.study.figures import USUAL_SOLVES
from flexspline.pipeline.study.holes import HolesEffect
from flexspline.pipeline.study.source import solves_of
from flexspline.pipeline.study.store import TrialStore
from flexspline.pipeline.study.study import Study

START_NOTE = "start"


def start_outcome(
    study: Study,
    store: TrialStore,
    holes: HolesEffect | None,
    evaluation: Callable[[Task], Outcome] = evaluate,
) -> Outcome:
    """Return the first design's figures by the study's solves; they are kept with its trials."""
    stored = store.notes().get(START_NOTE)
    if stored is None:
        tables = study.design.tables
        stored = asdict(evaluation(Task(tables, {}, solves_of(study, USUAL_SOLVES), holes)))
        store.note(START_NOTE, stored)
    return outcome_of(stored)
