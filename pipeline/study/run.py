"""A study from its file to its rows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, ExitStack
from dataclasses import asdict, replace
from functools import cache, partial
from pathlib import Path
from typing import Any

from flexspline.pipeline.study.cluster import WorkerPool, worker_pool
from flexspline.pipeline.study.database import StorageError, open_trial_store
from flexspline.pipeline.study.drive import (
    NOBODY,
    Source,
    StudyListener,
    evaluate_all,
    is_complete,
    within,
)
from flexspline.pipeline.study.evaluate import Outcome, Task, evaluate, fast_K_e
from flexspline.pipeline.study.figures import USUAL_SOLVES
from flexspline.pipeline.study.holes import (
    HOLE_EFFECT_DRIFT,
    HolesEffect,
    UnknownEffect,
    drifts,
    holes_of,
)
from flexspline.pipeline.study.plan import grid, sobol
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.samplers import sampler_of
from flexspline.pipeline.study.scatter import ScatterError, scatter_of
from flexspline.pipeline.study.source import PlannedDesigns, SampledDesigns, solves_of, study_name
from flexspline.pipeline.study.start import start_outcome
from flexspline.pipeline.study.storage_faults import TrialStoreError, helps
from flexspline.pipeline.study.store import TrialStore
from flexspline.pipeline.study.study import Study
from flexspline.pipeline.study.tolerance import ScatteredDesigns, scattered
from flexspline.pipeline.study.verify import verify

HOLES_NOTE = "holes"


def source_of(study: Study, holes: HolesEffect | None = None) -> Source:
    """Return the source of a study's designs, and the correction of their K_e for holes."""
    if study.file.run.method == "tolerance":
        return scattered(study, holes)
    solves = solves_of(study, USUAL_SOLVES)
    if study.file.run.method == "optimize":
        return SampledDesigns(study, solves, holes=holes)
    plan = grid(study) if study.file.run.method == "grid" else sobol(study)
    return PlannedDesigns(study, solves, plan, holes=holes)


def nominal_holes(
    study: Study, store: TrialStore, say: Callable[[str], None]
) -> HolesEffect | UnknownEffect | None:
    """Return the effect of the shaft's holes and keyway on K_e of the design that the study begins with.

    Kept with the study's trials: every row has the same share, whoever makes it and when. What time or memory
    was too short for is looked for again, until a design is begun without it.
    """
    stored = store.notes().get(HOLES_NOTE)
    if _is_sought(stored, store):
        effect = holes_of(
            study.design, fast_K_e, say, HOLE_EFFECT_DRIFT if drifts(study.keys) else 0.0
        )
        stored = store.notes().get(HOLES_NOTE)  # another process may have been faster
        if _is_sought(stored, store):
            stored = asdict(effect) if effect else {}
            store.note(HOLES_NOTE, stored)
    if not stored:
        return None
    return UnknownEffect(**stored) if "reason" in stored else HolesEffect(**stored)


def _is_sought(stored: Mapping[str, Any] | None, store: TrialStore) -> bool:
    """Whether the holes' effect, as it is stored, is still to be found."""
    return stored is None or (bool(stored.get("passing")) and not store.is_begun())


def trial_store_of(study: Study, folder: Path) -> TrialStore:
    """Open the study's trials in its storage, `study.db` in `folder` where none is named.

    Raises
    ------
    StorageError : the storage that the study names cannot be opened.
    TrialStoreError : `study.db` cannot.
    """
    url = study.file.run.storage
    database = folder / "study.db"
    if not url:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as fault:
            reason = fault.strerror or str(fault)
            raise TrialStoreError(
                f"{folder}: cannot be made ({reason})", "name another folder"
            ) from None
    directions = list(study.file.objective.values()) or ["minimize"]
    try:
        given = url or f"sqlite:///{database.resolve()}"
        return open_trial_store(given, study_name(study), directions, sampler_of(study))
    except StorageError as fault:
        if url:
            raise
        raise TrialStoreError(f"{database}: {fault.cause}", helps(fault)) from fault


def whole_study(
    study: Study,
    store: TrialStore,
    listener: StudyListener = NOBODY,
) -> StudyResult:
    """Run the study with the workers that it asks for, its K_e corrected for holes.

    Where it found a best design, the figures of the design that it began with stand beside it.
    """
    run = study.file.run
    pool = partial(worker_pool, run.workers, run.scheduler)
    effect = nominal_holes(study, store, listener.say)
    holes = effect if isinstance(effect, HolesEffect) else None
    result = run_study(study, store, pool, listener=listener, holes=holes)
    if isinstance(effect, UnknownEffect):
        result = replace(result, no_holes_effect=effect.reason)
    if result.about_scatter or not result.pareto:
        return result
    return replace(result, start=start_outcome(study, store, holes))


def run_study(
    study: Study,
    store: TrialStore,
    pool: Callable[[], AbstractContextManager[WorkerPool]],
    evaluation: Callable[[Task], Outcome] = evaluate,
    listener: StudyListener = NOBODY,
    holes: HolesEffect | None = None,
) -> StudyResult:
    """Evaluate what is not yet evaluated, verify the best; `pool` opens only where there is work.

    Raises
    ------
    ComputationError : the cluster went away. Designs that fail are rows.
    """
    source = source_of(study, holes)
    with ExitStack() as stack:

        @cache
        def opened() -> WorkerPool:
            return stack.enter_context(pool())

        if not is_complete(source, store):
            evaluate_all(source, store, opened(), evaluation, listener.watch)
        rows = within(store.rows(), source.size)
        result = _scattered(StudyResult(study, rows), source)
        return replace(result, verified=verify(result, store, opened, source.task, listener.say))


def _scattered(result: StudyResult, source: Source) -> StudyResult:
    """With what a tolerance study tells; too many designs that fail cost that, not the rows."""
    if not isinstance(source, ScatteredDesigns):
        return result
    seed, keys = result.study.file.run.seed, result.study.outputs
    try:
        scatters = tuple(scatter_of(k, source.inputs, result.rows, seed) for k in keys)
    except ScatterError as fault:
        return replace(result, unscattered=str(fault))
    return replace(result, scatter=scatters)
