"""Trials in Optuna's storage: claimed by being created, finished with their row, never lost.

A design of a study is a slot, 0, 1, 2, …. Whoever wants to evaluate slots takes the study's lock in the
database, reads which are free, and creates RUNNING trials that say which slot, which attempt and who. So
two processes never have one design. (Optuna's own queue of waiting trials is not safe between processes
on SQLite: two can pop one trial.) A trial whose owner is gone is closed and its slot is free again.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property, wraps
from itertools import islice
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar, cast

from flexspline.pipeline.process_id import parsed
from flexspline.pipeline.study.claims import CLAIM, ROW, Claim, Claims, Row, Try
from flexspline.pipeline.study.evaluate import Outcome
from flexspline.pipeline.study.storage_faults import OpenedFile, storage_faults
from flexspline.pipeline.study.trial_tables import TrialTables, Values

if TYPE_CHECKING:
    from optuna import Study as Trials
    from optuna.distributions import BaseDistribution
    from optuna.storages import RDBStorage
    from optuna.trial import Trial
    from sqlalchemy import Connection

BEAT_S = 10.0
"""How often a process says that it lives."""
SILENT_S = 60.0
"""A process that cannot be seen from here, and that said nothing for so long, is gone."""


P = ParamSpec("P")
T = TypeVar("T")


def _plainly(
    method: Callable[Concatenate[TrialStore, P], T],
) -> Callable[Concatenate[TrialStore, P], T]:
    """A method of the store whose faults come in plain words."""

    @wraps(method)
    def call(self: TrialStore, /, *args: P.args, **kwargs: P.kwargs) -> T:
        with storage_faults(self.file):
            return method(self, *args, **kwargs)

    return call


@dataclass(frozen=True)
class Finished:
    """The outcome of a claimed design; `objectives` are for Optuna, None where the design failed."""

    job: Try
    outcome: Outcome
    objectives: list[float] | None


@dataclass(frozen=True)
class TrialStore:
    """The trials of one study, as this process uses them."""

    trials: Trials
    storage: RDBStorage
    owner: str
    file: OpenedFile | None
    """None where the storage is no file."""
    _known: Claims = field(default_factory=Claims, init=False)

    @cached_property
    def _tables(self) -> TrialTables:
        study = self.storage.get_study_id_from_name(self.trials.study_name)
        return TrialTables(self.storage, study)

    def _read(self, connection: Connection) -> None:
        known = self._known
        known.take_in(self._tables.changed(connection, known.last_id, known.to_read_again()))

    @_plainly
    def refresh(self) -> Claims:
        """Return what is known of the trials, with what other processes did since."""
        with self._tables.reading() as connection:
            self._read(connection)
        return self._known

    def rows(self) -> list[Row]:
        """Finished designs by slot; should a slot have two, the first."""
        return self.refresh().rows()

    def is_begun(self) -> bool:
        """Whether a design has its row, or a living process works on one."""
        known, dead = self.refresh(), self.dead()
        return known.finished > 0 or any(t.claim.owner not in dead for t in known.open())

    @_plainly
    def claim(
        self,
        size: int,
        count: int,
        values: Callable[[int], Values],
        over: Mapping[str, BaseDistribution],
    ) -> list[Try]:
        """Claim up to `count` free designs below `size`: a dead process's first, then new ones.

        One transaction, under the study's lock: what was read as free in it is so when it ends.

        Parameters
        ----------
        values, over : of the keys that a slot's trial is made with, and their distributions.
        """
        known = self.refresh()
        dead = self.dead()
        if next(known.free(size, dead), None) is None:
            return []
        with self._tables.locked() as connection:
            self._read(connection)
            slots = list(islice(known.free(size, dead), count))
            if not slots:
                return []
            claims = [Claim(s, _attempt(known.tries.get(s)), self.owner) for s in slots]
            given = [as_stored(values(s), over) for s in slots]
            new = [({CLAIM: asdict(c)}, v) for c, v in zip(claims, given, strict=True)]
            first = known.last_number + 1
            ids = self._tables.create(connection, first, new, over)
        known.held.update(ids)
        known.last_id, known.last_number = ids[-1], first + len(ids) - 1
        jobs = [
            Try(at, first + i, c, v, finished=False)
            for i, (at, c, v) in enumerate(zip(ids, claims, given, strict=True))
        ]
        for job in jobs:
            known.add_try(job)
        return jobs

    def tries(self, slot: int) -> list[Try]:
        """Return the tries of a slot without a row, as last read."""
        return list(self._known.tries.get(slot, {}).values())

    def values(self, but: int = -1) -> list[Values]:
        """Return the values of every design ever claimed, as last read; of all slots or all but one."""
        known = self._known
        tried = [t.values for s, tries in known.tries.items() if s != but for t in tries.values()]
        return tried + [r.values for r in known.rows() if r.slot != but]

    @_plainly
    def suggested(self, job: Try, over: Mapping[str, BaseDistribution]) -> Try:
        """Return a claimed design with the sampler's values, as `optuna.Study.ask` finds them."""
        from optuna.trial import Trial

        self.trials.get_trials(deepcopy=False)  # Optuna's cache hears of the trial
        trial = Trial(self.trials, job.trial_id)
        values = {key: _sampled(trial, key, span) for key, span in over.items()}
        valued = replace(job, values=values)
        self._known.add_try(valued)
        return valued

    @_plainly
    def finish(self, finished: Sequence[Finished]) -> None:
        """Store rows and close their trials, all in one transaction."""
        attributes = {
            f.job.trial_id: ({ROW: asdict(f.outcome)}, f.objectives) for f in finished
        }  # fmt: skip
        with self._tables.locked() as connection:
            closed = self._tables.close(connection, attributes)
        for f in finished:
            self._known.held.discard(f.job.trial_id)
            if f.job.trial_id in closed:
                self._known.add_row(f.job.number, Row(f.job.slot, f.job.values, f.outcome))

    @_plainly
    def teach(self, finished: Finished) -> None:
        """Store a row, then close the trial as Optuna does, so that its sampler hears of it; a stop
        between the two loses nothing."""
        from optuna.exceptions import UpdateFinishedTrialError

        job = finished.job
        with suppress(UpdateFinishedTrialError):  # taken for dead meanwhile: another has the design
            self.storage.set_trial_user_attr(job.trial_id, ROW, asdict(finished.outcome))
            self.tell(job.number, finished.objectives)
        self._known.held.discard(job.trial_id)

    @_plainly
    def tell(self, number: int, values: list[float] | None) -> None:
        """Close a trial: with its objectives, or as failed; closed ones stay as they are."""
        from optuna.exceptions import UpdateFinishedTrialError
        from optuna.trial import TrialState

        state = TrialState.FAIL if values is None else TrialState.COMPLETE
        with suppress(UpdateFinishedTrialError):  # another process did so just now
            self.trials.tell(number, values, state=state, skip_if_finished=True)

    def give_up(self, job: Try) -> None:
        """Close a claimed trial without a row: its design is free again."""
        self.tell(job.number, None)
        self._known.held.discard(job.trial_id)

    def release(self) -> None:
        """Close what this process claimed and has not finished: it is free again.

        What fails of it is left to whoever finds the process gone.
        """
        known = self._known
        with suppress(Exception):
            for one in [t for t in known.open() if t.trial_id in known.held]:
                self.tell(one.number, None)
                known.held.discard(one.trial_id)

    @_plainly
    def notes(self) -> dict[str, Any]:
        """Return what is stored beside the trials, by name."""
        return dict(self.trials.user_attrs)

    @_plainly
    def note(self, name: str, value: Any) -> None:
        """Store something beside the trials: numbers, texts, lists and tables of them."""
        self.trials.set_user_attr(name, value)

    def beat(self) -> None:
        """Show other processes that this one lives."""
        self.note(f"beat {self.owner}", time.time())

    def dead(self) -> set[str]:
        """Return the processes that hold designs but have ended, as far as is known."""
        owners = {t.claim.owner for t in self._known.open()} - {self.owner}
        return {o for o in owners if self._gone(o)}

    def _gone(self, owner: str) -> bool:
        process = parsed(owner)
        if process is not None and process.fate != "unknown":
            return process.fate == "gone"
        beat = self.notes().get(f"beat {owner}", 0.0)
        return bool(time.time() - beat > SILENT_S)


def _sampled(trial: Trial, key: str, span: BaseDistribution) -> float:
    """The sampler's value of a key, within one of the spans that studies have (`source.py`)."""
    from optuna.distributions import CategoricalDistribution, FloatDistribution, IntDistribution

    match span:
        case CategoricalDistribution():
            return cast(float, trial.suggest_categorical(key, span.choices))
        case IntDistribution():
            return trial.suggest_int(key, span.low, span.high)
        case FloatDistribution():
            return trial.suggest_float(key, span.low, span.high)
    raise TypeError(f"no span of a study: {span}")


def _attempt(tries: Mapping[int, Try] | None) -> int:
    """Which one comes next."""
    return 1 + max((t.claim.attempt for t in (tries or {}).values()), default=-1)


def as_stored(values: Values, over: Mapping[str, BaseDistribution]) -> dict[str, float]:
    """Return values as the database gives them back: a whole number as such."""
    return {k: over[k].to_external_repr(over[k].to_internal_repr(v)) for k, v in values.items()}
