"""Sources of designs: a plan known beforehand, or Optuna's sampler that learns from the rows."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from flexspline.pipeline.cache import FORMAT
from flexspline.pipeline.study.claims import Try
from flexspline.pipeline.study.evaluate import Outcome, Task
from flexspline.pipeline.study.figures import Solve, needed
from flexspline.pipeline.study.holes import HolesEffect
from flexspline.pipeline.study.plan import StudyPlan, linked, spread
from flexspline.pipeline.study.store import Finished, TrialStore
from flexspline.pipeline.study.study import Study
from flexspline.pipeline.study.trial_tables import Values

if TYPE_CHECKING:
    from optuna.distributions import BaseDistribution


ASKED_AGAIN = 20
"""A sampler that suggests a design the study has already is asked again so many times."""
DRAWN_AGAIN = 200
"""Random designs tried; where lists leave one new design in 40, all of them are old once in 150 times."""


@dataclass(frozen=True)
class _Asked:
    """What both sources do alike."""

    study: Study
    solves: tuple[Solve, ...]
    holes: HolesEffect | None = field(default=None, kw_only=True)

    @cached_property
    def _tables(self) -> dict[str, Any]:
        return self.study.design.tables

    @cached_property
    def over(self) -> Mapping[str, BaseDistribution]:
        """Optuna's distributions of the varied keys."""
        return distributions(self.study)

    def task(self, values: Mapping[str, float]) -> Task:
        return Task(self._tables, linked(self.study, values), self.solves, self.holes)

    def objectives(self, outcome: Outcome) -> list[float] | None:
        if not self.study.is_answered(outcome.figures):
            return None
        return [outcome.figures[k] for k in self.study.file.objective] or [0.0]


@dataclass(frozen=True)
class PlannedDesigns(_Asked):
    """Designs of a plan."""

    plan: StudyPlan

    @property
    def size(self) -> int:
        return self.plan.size

    def ahead(self, width: int) -> int:
        return width

    def claim(self, store: TrialStore, count: int) -> list[Try]:
        return store.claim(self.size, count, self.plan.point, self.over)

    def store(self, store: TrialStore, finished: Sequence[Finished]) -> None:
        store.finish(finished)


@dataclass(frozen=True)
class SampledDesigns(_Asked):
    """Designs that Optuna's sampler suggests, learning from those before."""

    @property
    def size(self) -> int:
        return self.study.file.run.evaluations

    def ahead(self, width: int) -> int:
        return 0  # a design chosen later knows more

    def claim(self, store: TrialStore, count: int) -> list[Try]:
        """One design, or none. A slot is taken first, and then given values: two processes cannot both
        have it."""
        for _ in range(ASKED_AGAIN):
            taken = store.claim(self.size, 1, partial(self._before, store), self.over)
            if not taken or taken[0].values:
                return taken
            had = store.values(but=taken[0].slot)
            job = store.suggested(taken[0], self.over)
            if job.values not in had:
                return [job]
            store.give_up(job)
        had = store.values()
        return store.claim(self.size, 1, partial(self._unseen, had=had), self.over)

    def store(self, store: TrialStore, finished: Sequence[Finished]) -> None:
        for one in finished:
            store.teach(one)

    def _before(self, store: TrialStore, slot: int) -> Values:
        """The values that a dead process had for a slot; none where it died before it had them all, or
        gave them up because another design has them."""
        had, keys = store.values(but=slot), set(self.over)
        tried = (t.values for t in store.tries(slot))
        return next((v for v in tried if set(v) == keys and v not in had), {})

    def _unseen(self, slot: int, had: Sequence[Values]) -> dict[str, float]:
        """A random design that the study has not had; any, where its lists leave none."""
        random = np.random.default_rng([self.study.file.run.seed, slot])
        for _ in range(DRAWN_AGAIN):
            unit = random.random((1, len(self.study.file.vary)))
            values = dict(
                zip(self.study.file.vary, spread(self.study, unit)[0].tolist(), strict=True)
            )
            if values not in had:
                break
        return values


def solves_of(study: Study, usual: tuple[Solve, ...]) -> tuple[Solve, ...]:
    """Return the solves of every design of a study."""
    return needed({**study.file.objective, **study.file.constraint}, usual)


def distributions(study: Study) -> dict[str, BaseDistribution]:
    """Return Optuna's distributions of [vary]."""
    from optuna.distributions import CategoricalDistribution, FloatDistribution, IntDistribution

    of_keys: dict[str, BaseDistribution] = {}
    for key, span in study.file.vary.items():
        if span.values is not None:
            of_keys[key] = CategoricalDistribution(span.values)
        elif key in study.whole:
            low, high = span.ends
            of_keys[key] = IntDistribution(int(low), int(high))
        else:
            of_keys[key] = FloatDistribution(*span.ends)
    return of_keys


def study_name(study: Study) -> str:
    """Return the file's name and a digest of all that changes a row's meaning, or which rows there are."""
    file = study.file.model_dump(mode="json", exclude={"run", "design"})
    run = study.file.run
    identity: dict[str, Any] = {
        "design": study.design.model_dump(mode="json"),
        "study": file,
        "holes": "K_b enclosed, K_e by a share of the cut pieces' compliance",
        "row": "figures, faults, seconds",
        "program": FORMAT,  # what a row means changes with what a stage means
        "method": run.method,
        "seed": run.seed,
    }
    if run.method in ("grid", "tolerance"):  # their points depend on how many there are
        identity["evaluations"] = run.evaluations
    digest = hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest()[:12]
    return f"{study.name}-{run.method}-{digest}"
