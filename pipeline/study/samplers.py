"""Optuna's samplers, each trial's drawn from its own stream of random numbers.

A sampler with one seed would repeat its first suggestions after every restart, and in every process that
shares the study. Seeded by (study's seed, trial's number) each trial has its own, whoever asks for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeline.study.load import Study
from pipeline.study.store import ROW

if TYPE_CHECKING:
    from optuna.samplers import BaseSampler
    from optuna.trial import FrozenTrial

POPULATION = (8, 50)
"""Least and largest of NSGA-II: an eighth of the evaluations between them."""
STARTUP = 10


def sampler_of(study: Study) -> BaseSampler:
    """TPE for one objective, NSGA-II for several, with the study's constraints."""
    from optuna.samplers import BaseSampler, NSGAIISampler, TPESampler

    file = study.file
    limits = file.constraint

    def excesses(trial: FrozenTrial) -> Sequence[float]:
        figures = trial.user_attrs.get(ROW, {}).get("figures") or {}
        return [limit.excess(figures[k]) if k in figures else 1.0 for k, limit in limits.items()]

    constraints = excesses if limits else None

    def fresh(seed: int) -> BaseSampler:
        if len(file.objective) > 1:
            size = int(np.clip(file.run.evaluations // 8, *POPULATION))
            return NSGAIISampler(population_size=size, seed=seed, constraints_func=constraints)
        return TPESampler(
            seed=seed, multivariate=True, n_startup_trials=STARTUP, constant_liar=True,
            constraints_func=constraints,
        )  # fmt: skip

    class Seeded(BaseSampler):
        """Delegates to a sampler seeded for the trial."""

        def _of(self, trial: FrozenTrial) -> BaseSampler:
            state = np.random.SeedSequence([file.run.seed, trial.number]).generate_state(1)
            return fresh(int(state[0]))

        def infer_relative_search_space(self, study: Any, trial: FrozenTrial) -> dict[str, Any]:
            return self._of(trial).infer_relative_search_space(study, trial)

        def sample_relative(self, study: Any, trial: FrozenTrial, search_space: Any) -> Any:
            return self._of(trial).sample_relative(study, trial, search_space)

        def sample_independent(self, study: Any, trial: FrozenTrial, name: str, over: Any) -> Any:
            # one stream per key, or keys of equal spans would get equal numbers
            words = [file.run.seed, trial.number, *name.encode()]
            seed = int(np.random.SeedSequence(words).generate_state(1)[0])
            return fresh(seed).sample_independent(study, trial, name, over)

        def after_trial(self, study: Any, trial: FrozenTrial, state: Any, values: Any) -> None:
            self._of(trial).after_trial(study, trial, state, values)

    return Seeded()
