"""Trials in Optuna's storage: claimed by being created, finished with their row, never lost.

A design of a study is a slot, 0, 1, 2, …. Whoever wants to evaluate a slot creates a RUNNING trial that
says which slot, which attempt and who; trial numbers are given one after the other by the database, so
among trials that claim the same attempt of the same slot the lowest number has it and the others
withdraw. (Optuna's own queue of waiting trials is not safe between processes on SQLite: two can pop one
trial.) A trial whose owner is gone is closed and its slot's next attempt is free.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

from flexspline.geometry.errors import ComputationError, one_line
from flexspline.pipeline.process_id import parsed
from flexspline.pipeline.study.evaluate import Outcome

if TYPE_CHECKING:
    from optuna import Study as Trials
    from optuna.distributions import BaseDistribution
    from optuna.storages import BaseStorage
    from optuna.trial import FrozenTrial

CLAIM, ROW = "claim", "row"
BEAT_S = 10.0
"""How often a process says that it lives."""
SILENT_S = 60.0
"""A process that cannot be seen from here, and that said nothing for so long, is gone."""


class TrialStoreError(ComputationError):
    """The storage of a study does not work: a full disk, a damaged file, a database gone."""

    def __init__(self, reason: str) -> None:
        super().__init__(
            f"the study's storage does not work: {reason}; what is stored is kept: run the same "
            "command again to resume"
        )


@contextmanager
def storage_faults() -> Iterator[None]:
    """What the database and its libraries raise, as a TrialStoreError."""
    from optuna.exceptions import StorageInternalError
    from sqlalchemy.exc import SQLAlchemyError

    try:
        yield
    except (SQLAlchemyError, StorageInternalError) as fault:
        raise TrialStoreError(said(fault)) from fault


def said(fault: BaseException) -> str:
    """The database's own words, without the statement and its values."""
    while isinstance(fault.__cause__, Exception):
        fault = fault.__cause__
    return one_line((str(fault) or type(fault).__name__).splitlines()[0])


@dataclass(frozen=True)
class Claim:
    """Which design, which attempt at it, by which process."""

    slot: int
    attempt: int
    owner: str


@dataclass(frozen=True)
class Row:
    """One finished design: values of the varied keys and what came out."""

    slot: int
    values: Mapping[str, float]
    outcome: Outcome


@dataclass(frozen=True)
class Job:
    """A claimed design: the trial that holds it."""

    trial_id: int
    number: int
    slot: int
    values: Mapping[str, float]


@dataclass(frozen=True)
class TrialStore:
    """The trials of one study, as this process uses them."""

    trials: Trials
    storage: BaseStorage
    owner: str

    @storage_faults()
    def all(self) -> list[FrozenTrial]:
        """Every trial, as the database has it now."""
        return self.trials.get_trials(deepcopy=False)

    def rows(self) -> list[Row]:
        """Finished designs by slot; should a slot have two, the first."""
        found: dict[int, Row] = {}
        for trial in self.all():
            if ROW in trial.user_attrs and trial.state.is_finished():
                slot = trial.user_attrs[CLAIM]["slot"]
                found.setdefault(slot, Row(slot, trial.params, Outcome(**trial.user_attrs[ROW])))
        return [found[slot] for slot in sorted(found)]

    def by_slot(self) -> dict[int, list[FrozenTrial]]:
        """Trials that claim each slot, in their order."""
        found: dict[int, list[FrozenTrial]] = {}
        for trial in self.all():
            if CLAIM in trial.user_attrs:
                found.setdefault(trial.user_attrs[CLAIM]["slot"], []).append(trial)
        return found

    @storage_faults()
    def create(
        self,
        slot: int,
        attempt: int,
        values: Mapping[str, float],
        over: Mapping[str, BaseDistribution],
    ) -> Job | None:
        """A RUNNING trial, made in one transaction; None where another process has the attempt."""
        from optuna.trial import TrialState, create_trial

        claim = asdict(Claim(slot, attempt, self.owner))
        self.trials.add_trial(
            create_trial(
                state=TrialState.RUNNING,
                params=dict(values),
                distributions=dict(over),
                user_attrs={CLAIM: claim},
            )
        )
        rivals = [
            t for t in self.by_slot()[slot] if t.user_attrs[CLAIM]["attempt"] == attempt
        ]  # fmt: skip
        mine = next(t for t in reversed(rivals) if t.user_attrs[CLAIM]["owner"] == self.owner)
        if rivals[0].number == mine.number:
            return Job(mine._trial_id, mine.number, slot, values)
        self.tell(mine.number, None)
        return None

    @storage_faults()
    def suggested(self, job: Job, over: Mapping[str, BaseDistribution]) -> Job:
        """A claimed design with the sampler's values, as `optuna.Study.ask` finds them."""
        from optuna.trial import Trial

        trial = Trial(self.trials, job.trial_id)
        values = {key: float(trial._suggest(key, span)) for key, span in over.items()}
        return replace(job, values=values)

    @storage_faults()
    def finish(self, job: Job, outcome: Outcome, values: list[float] | None) -> None:
        """Store the row, then close the trial; a stop between the two loses nothing."""
        self.storage.set_trial_user_attr(job.trial_id, ROW, asdict(outcome))
        self.tell(job.number, values)

    @storage_faults()
    def tell(self, number: int, values: list[float] | None) -> None:
        """Close a trial: with its objectives, or as failed; closed ones stay as they are."""
        from optuna.exceptions import UpdateFinishedTrialError
        from optuna.trial import TrialState

        state = TrialState.FAIL if values is None else TrialState.COMPLETE
        with suppress(UpdateFinishedTrialError):  # another process did so just now
            self.trials.tell(number, values, state=state, skip_if_finished=True)

    @storage_faults()
    def notes(self) -> dict[str, Any]:
        """What is stored beside the trials, by name."""
        return dict(self.trials.user_attrs)

    @storage_faults()
    def note(self, name: str, value: Any) -> None:
        """Store something beside the trials: numbers, texts, lists and tables of them."""
        self.trials.set_user_attr(name, value)

    def beat(self) -> None:
        """Say that this process lives, for those that cannot see it."""
        self.note(f"beat {self.owner}", time.time())

    def gone(self, trial: FrozenTrial) -> bool:
        """Whether the process that claimed a trial is no more."""
        owner = trial.user_attrs[CLAIM]["owner"]
        process = parsed(owner)
        if process is not None and process.fate != "unknown":
            return process.fate == "gone"
        beat = self.notes().get(f"beat {owner}", 0.0)
        return bool(time.time() - beat > SILENT_S)
