"""The best designs solved again with the solid model, holes and keyway included, beside the fast one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import as_completed
from dataclasses import asdict, dataclass

from flexspline.fea.shortfall import missing_because
from flexspline.geometry.design import Design, Solver
from flexspline.geometry.keys import with_values
from flexspline.geometry.load import design_from
from flexspline.pipeline.analysis import analysis_context, backlash_of, stiffnesses
from flexspline.pipeline.errors import NestingError
from flexspline.pipeline.load_cases import SOLID_CASES
from flexspline.pipeline.rim_case import figure_of
from flexspline.pipeline.stiffnesses import NotFoundError, Stiffnesses
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.cluster import WorkerPool
from flexspline.pipeline.study.design_faults import DESIGN_FAULTS
from flexspline.pipeline.study.evaluate import Outcome, Task, outcome_of
from flexspline.pipeline.study.figures import GIVEN_BY, stiffness_figures, stiffness_keys
from flexspline.pipeline.study.local_workers import WORKER_DIED
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.store import TrialStore
from flexspline.pipeline.study.verified import Check, Verified

VERIFIED = "verified"
RIM = {key for case in SOLID_CASES for key in GIVEN_BY[case]} | {*GIVEN_BY["ellipse"]}


@dataclass(frozen=True)
class SolidAnswer:
    """A design's figures by the solid model, or why there are none.

    `passing`: whether more time or memory would find some that are missing.
    """

    outcome: Outcome
    passing: bool = False


DIED = SolidAnswer(Outcome(faults=(WORKER_DIED,)), passing=True)
"""Most often for want of memory: the system ended the process."""


def solid_answer(task: Task, rim: bool) -> SolidAnswer:
    """Solve one design by the solid model; `rim`: the lobes and the ellipse too."""
    try:
        tables = dict(task.tables)
        tables["solver"] = {**tables.get("solver", {}), "model": "solid"}
        design = with_values(design_from(tables), task.values)
        context = analysis_context(design)
        result = stiffnesses(context, rim=rim or design.solver.sum_at_lobes)
        return SolidAnswer(Outcome(_figures(design, result)), result.passing)
    except NestingError as fault:
        return SolidAnswer(Outcome(faults=(str(fault),), contradicted=True))
    except NotFoundError as fault:
        return SolidAnswer(Outcome(faults=(str(fault),)), fault.stiffnesses.passing)
    except (*DESIGN_FAULTS, MemoryError) as fault:
        why = missing_because(fault)
        return SolidAnswer(Outcome(faults=(why.words,)), why.of_the_machine)


def _figures(design: Design, result: Stiffnesses) -> dict[str, float]:
    """By result.json key; raises NotFoundError without the K of the backlash sum."""
    total = backlash_of(design, result)
    figures = {
        "backlash_arcsec.shaft": total.shaft_arcsec,
        "backlash_arcsec.flexspline": total.flexspline_arcsec,
        "backlash_arcsec.total": total.total_arcsec,
    }
    for name in ("K_b", "K_e", *map(figure_of, SOLID_CASES)):
        if name in result.solved:
            figures |= stiffness_figures(name, result[name])
    if result.wave_generator_peak is not None:
        figures["wave_generator_peak_mises_MPa"] = result.wave_generator_peak.mises_MPa
    return figures


def verify(
    result: StudyResult,
    store: TrialStore,
    pool: Callable[[], WorkerPool],
    task: Callable[[Mapping[str, float]], Task],
    say: Callable[[str], None],
) -> tuple[Verified, ...]:
    """Solve the first `run.verify` of the best designs; what is stored is not solved again.

    An answer that time or memory was too short for is of this run only: the next one solves it again.
    """
    file = result.study.file
    chosen = result.best(file.run.verify)
    rim = bool(RIM & {*file.objective, *file.constraint})
    stored = store.notes()
    pending = {}
    for row in chosen:
        if f"{VERIFIED} {row.slot}" not in stored:
            say(f"design {row.slot} with the solid model")
            pending[pool().submit(solid_answer, task(row.values), rim)] = row
    for future in as_completed(pending):
        name = f"{VERIFIED} {pending[future].slot}"
        try:
            answer: SolidAnswer = future.result()
        except pool().lost:
            answer = DIED
        stored[name] = asdict(answer.outcome)
        if not answer.passing:
            store.note(name, stored[name])
    solver = result.study.design.solver
    return tuple(checked(r, outcome_of(stored[f"{VERIFIED} {r.slot}"]), solver) for r in chosen)


def checked(row: Row, solid: Outcome, solver: Solver) -> Verified:
    """Return figures of both models, side by side; `solver` says which K_b is in the backlash."""
    fast = row.outcome.figures
    K_b = f"{solver.K_b_in_sum}_Nm_per_rad"
    keys = [k for k in solid.figures if k in fast and not k.endswith(("]", "shaft", "flexspline"))]
    checks = tuple(
        Check(k, fast[k], _bounds(fast, k, K_b), solid.figures[k], _bounds(solid.figures, k, K_b))
        for k in keys
    )
    return Verified(row.slot, checks, solid.reason, solid.contradicted)


def _bounds(figures: Mapping[str, float], key: str, K_b: str) -> tuple[float, float] | None:
    if key == "backlash_arcsec.total":
        return _windup_bounds(figures, K_b)
    _, low, high = stiffness_keys(key.removesuffix("_Nm_per_rad"))
    return (figures[low], figures[high]) if low in figures else None


def _windup_bounds(figures: Mapping[str, float], K_b: str) -> tuple[float, float]:
    """Of the total backlash: both wind-ups go as 1/K between K's bounds."""
    off = [0.0, 0.0]
    for term, key in (("shaft", "K_e_Nm_per_rad"), ("flexspline", K_b)):
        bounds = _bounds(figures, key, K_b)
        if bounds is not None:
            for i, end in enumerate(reversed(bounds)):
                off[i] += figures[f"backlash_arcsec.{term}"] * (figures[key] / end - 1)
    total = figures["backlash_arcsec.total"]
    return total + off[0], total + off[1]
