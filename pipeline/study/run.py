"""A study from its file to its rows."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

from pipeline.study.cluster import Hands
from pipeline.study.drive import Progress, Source, carry_out, is_complete
from pipeline.study.evaluate import Outcome, Task, evaluate
from pipeline.study.figures import USUAL
from pipeline.study.load import Study
from pipeline.study.plan import Sobol, grid
from pipeline.study.result import StudyResult
from pipeline.study.samplers import sampler_of
from pipeline.study.scatter import Scatter, scatter_of
from pipeline.study.source import Planned, Sampled, solves_of, study_name
from pipeline.study.store import Ledger, open_ledger
from pipeline.study.tolerance import Scattered, outputs_of, scattered


def source_of(study: Study) -> Source:
    """Where a study's designs come from."""
    if study.file.run.method == "tolerance":
        return scattered(study)
    solves = solves_of(study, USUAL)
    if study.file.run.method == "optimize":
        return Sampled(study, solves)
    return Planned(study, solves, grid(study) if study.file.run.method == "grid" else Sobol(study))


def ledger_of(study: Study, folder: Path) -> Ledger:
    """The study's trials in its storage, `study.db` in `folder` where none is named.

    Raises
    ------
    StorageError
    """
    url = study.file.run.storage
    if not url:
        folder.mkdir(parents=True, exist_ok=True)
        url = f"sqlite:///{(folder / 'study.db').resolve()}"
    directions = list(study.file.objective.values()) or ["minimize"]
    return open_ledger(url, study_name(study), directions, sampler_of(study))


def run_study(
    study: Study,
    ledger: Ledger,
    hands: Callable[[], AbstractContextManager[Hands]],
    watch: Callable[[Progress], None],
    evaluation: Callable[[Task], Outcome] = evaluate,
) -> StudyResult:
    """Evaluate what is not yet evaluated; all rows. `hands` opens only where there is work.

    Raises
    ------
    ComputationError : the cluster went away. Designs that fail are rows.
    """
    source = source_of(study)
    if not is_complete(source, ledger):
        with hands() as open_hands:
            carry_out(source, ledger, open_hands, evaluation, watch)
    rows = tuple(ledger.rows()[: source.size])
    scatter: tuple[Scatter, ...] = ()
    if isinstance(source, Scattered):
        seed = study.file.run.seed
        scatter = tuple(scatter_of(k, source.inputs, rows, seed) for k in outputs_of(study))
    return StudyResult(study, rows, scatter)
