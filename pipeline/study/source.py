"""Sources of designs: a plan known beforehand, or Optuna's sampler that learns from the rows."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from flexspline.pipeline.study.evaluate import Outcome, Task
from flexspline.pipeline.study.figures import Solve, needed
from flexspline.pipeline.study.holes import Factor
from flexspline.pipeline.study.load import Study
from flexspline.pipeline.study.plan import Plan, from_unit, linked
from flexspline.pipeline.study.store import CLAIM, Job, TrialStore

if TYPE_CHECKING:
    from optuna.distributions import BaseDistribution
    from optuna.trial import FrozenTrial


ASKED_AGAIN = 20
"""A sampler that suggests a design the study has already is asked again so many times."""
DRAWN_AGAIN = 200
"""Random designs tried; where lists leave one new design in 40, all of them are old once in 150 times."""


@dataclass(frozen=True)
class _Asked:
    """What both sources do alike."""

    study: Study
    solves: tuple[Solve, ...]
    holes: Factor | None = field(default=None, kw_only=True)

    @cached_property
    def _tables(self) -> dict[str, Any]:
        return self.study.design.model_dump(mode="json", exclude_none=True)

    @property
    def over(self) -> Mapping[str, BaseDistribution]:
        """Optuna's distributions of the varied keys."""
        return distributions(self.study)

    def task(self, values: Mapping[str, float]) -> Task:
        return Task(self._tables, linked(self.study, values), self.solves, self.holes)

    def objectives(self, outcome: Outcome) -> list[float] | None:
        if not self.study.is_answered(outcome.figures):
            return None
        return [outcome.figures[k] for k in self.study.file.objective] or [0.0]

    def again(self, store: TrialStore, slot: int, attempt: int, before: FrozenTrial) -> Job | None:
        return store.create(slot, attempt, before.params, before.distributions)


@dataclass(frozen=True)
class Planned(_Asked):
    """Designs of a plan."""

    plan: Plan

    @property
    def size(self) -> int:
        return self.plan.size

    @property
    def ahead(self) -> int:
        return 1

    def claim(self, store: TrialStore, slot: int) -> Job | None:
        return store.create(slot, 0, self.plan.point(slot), self.over)


@dataclass(frozen=True)
class Sampled(_Asked):
    """Designs that Optuna's sampler suggests, learning from those before."""

    @property
    def size(self) -> int:
        return self.study.file.run.evaluations

    @property
    def ahead(self) -> int:
        return 0  # a design chosen later knows more

    def claim(self, store: TrialStore, slot: int) -> Job | None:
        return self._suggested(store, slot, 0)

    def again(self, store: TrialStore, slot: int, attempt: int, before: FrozenTrial) -> Job | None:
        if set(before.params) == set(self.over):
            return super().again(store, slot, attempt, before)
        return self._suggested(store, slot, attempt)  # its process died before it had values

    def _suggested(self, store: TrialStore, slot: int, attempt: int) -> Job | None:
        """The slot is taken first, in one transaction, and then given values: two processes cannot
        both have it."""
        had = [t.params for t in store.all() if CLAIM in t.user_attrs]
        for further in range(ASKED_AGAIN):
            taken = store.create(slot, attempt + further, {}, {})
            if taken is None:
                return None
            job = store.suggested(taken, self.over)
            if job.values not in had:
                return job
            store.tell(job.number, None)
        return store.create(slot, attempt + ASKED_AGAIN, self._unseen(slot, had), self.over)

    def _unseen(self, slot: int, had: list[dict[str, Any]]) -> dict[str, float]:
        """A random design that the study has not had; any, where its lists leave none."""
        random = np.random.default_rng([self.study.file.run.seed, slot])
        for _ in range(DRAWN_AGAIN):
            unit = random.random(len(self.study.file.vary))
            values = {
                key: from_unit(self.study, key, float(u))
                for key, u in zip(self.study.file.vary, unit, strict=True)
            }
            if values not in had:
                break
        return values


def solves_of(study: Study, usual: tuple[Solve, ...]) -> tuple[Solve, ...]:
    """What every design of a study is solved for."""
    return needed({**study.file.objective, **study.file.constraint}, usual)


def distributions(study: Study) -> dict[str, BaseDistribution]:
    """Optuna's words for [vary]."""
    from optuna.distributions import (
        CategoricalDistribution,
        FloatDistribution,
        IntDistribution,
    )

    found: dict[str, BaseDistribution] = {}
    for key, span in study.file.vary.items():
        if span.values is not None:
            found[key] = CategoricalDistribution(span.values)
        elif key in study.whole:
            low, high = span.ends
            found[key] = IntDistribution(int(low), int(high))
        else:
            found[key] = FloatDistribution(*span.ends)
    return found


def study_name(study: Study) -> str:
    """The file's name and a digest of all that changes what a row means, or which rows there are."""
    file = study.file.model_dump(mode="json", exclude={"run", "design"})
    run = study.file.run
    told: dict[str, Any] = {
        "design": study.design.model_dump(mode="json"),
        "study": file,
        "holes": "K_b enclosed, K_e by the nominal design's factor",
        "method": run.method,
        "seed": run.seed,
    }
    if run.method in ("grid", "tolerance"):  # their points depend on how many there are
        told["evaluations"] = run.evaluations
    digest = hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()[:12]
    return f"{study.name}-{run.method}-{digest}"
