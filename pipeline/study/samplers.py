"""Optuna's samplers; each trial has its own stream of random numbers.

A sampler with one seed would repeat its first suggestions after every restart, and in every process that
shares the study. Seeded by (study's seed, trial's number) each trial has its own, whoever asks for it.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from flexspline.pipeline.study.claims import ROW
from flexspline.pipeline.study.polish import near, polish_of
from flexspline.pipeline.study.study import Study
from flexspline.pipeline.study.trial_tables import Values

if TYPE_CHECKING:
    from optuna.samplers import BaseSampler
    from optuna.trial import FrozenTrial

POPULATION = (8, 50)
"""Least and largest of NSGA-II: an eighth of the evaluations between them."""
STARTUP = 10
"""Random designs before TPE models what it has seen: Optuna's default."""


def start_in_spans(study: Study) -> Values:
    """Return the values that the study begins with; none where a varied key has none within its span."""
    values = study.start_values
    for key, span in study.file.vary.items():
        low, high = span.ends
        value = values.get(key, inf)
        if not (value in span.values if span.values else low <= value <= high):
            return {}
    return values


def sampler_of(study: Study) -> BaseSampler:
    """Return TPE for one objective, with the best polished towards the end; NSGA-II for several."""
    from optuna.samplers import BaseSampler, NSGAIISampler, TPESampler

    file = study.file

    def constraint_values(trial: FrozenTrial) -> Sequence[float]:
        return study.excesses(trial.user_attrs.get(ROW, {}).get("figures") or {})

    constraints = constraint_values if file.constraint else None

    def fresh(seed: int) -> BaseSampler:
        with warnings.catch_warnings():
            # Optuna 5 prefers Trial.set_constraint, which a trial that another process finishes
            # cannot use; constraints_func works until its version 7
            warnings.simplefilter("ignore", FutureWarning)
            if len(file.objective) > 1:
                size = int(np.clip(file.run.evaluations // 8, *POPULATION))
                return NSGAIISampler(population_size=size, seed=seed, constraints_func=constraints)
            return TPESampler(
                seed=seed, multivariate=True, n_startup_trials=STARTUP, constant_liar=True,
                constraints_func=constraints,
            )  # fmt: skip

    def seed_of(trial: FrozenTrial, *more: int) -> int:
        words = [file.run.seed, trial.number, *more]
        return int(np.random.SeedSequence(words).generate_state(1)[0])

    start = start_in_spans(study)

    class Seeded(BaseSampler):
        """Delegates to a sampler seeded for the trial; the first is the study's own design."""

        def infer_relative_search_space(self, study: Any, trial: FrozenTrial) -> dict[str, Any]:
            return fresh(seed_of(trial)).infer_relative_search_space(study, trial)

        def sample_relative(self, study: Any, trial: FrozenTrial, search_space: Any) -> Any:
            past = study.get_trials(deepcopy=False)
            if len(file.objective) == 1:
                sense = next(iter(file.objective.values()))
                polish = polish_of(past, file.run.evaluations, sense, constraint_values)
                if polish is not None:
                    return near(polish, np.random.default_rng(seed_of(trial, 1)))
            return fresh(seed_of(trial)).sample_relative(study, trial, search_space)

        def sample_independent(self, study: Any, trial: FrozenTrial, name: str, over: Any) -> Any:
            if trial.number == 0 and name in start:
                return start[name]
            # one stream per key, or keys of equal spans would get equal numbers
            seed = seed_of(trial, *name.encode())
            return fresh(seed).sample_independent(study, trial, name, over)

        def after_trial(self, study: Any, trial: FrozenTrial, state: Any, values: Any) -> None:
            fresh(seed_of(trial)).after_trial(study, trial, state, values)

    return Seeded()
