"""Optuna's tables: changes are read, and many trials are written at a time.

Optuna's own calls make one transaction for each trial, and one more for each of its attributes: three a
design, each some milliseconds of the disk. Its `Study.get_trials` hands over all trials for every question.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from optuna.distributions import BaseDistribution
    from optuna.storages import RDBStorage
    from sqlalchemy import Connection

Values = Mapping[str, float]


@dataclass(frozen=True)
class StoredTrial:
    """A trial as the database has it: its attributes by key, and its values where it is finished."""

    trial_id: int
    number: int
    finished: bool
    attributes: Mapping[str, Any]
    values: Values


@dataclass(frozen=True)
class TrialTables:
    """The trials of one study.

    Attributes
    ----------
    study_id : of the study, in Optuna's table of studies.
    """

    storage: RDBStorage
    study_id: int

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        with self.storage.engine.connect() as connection:
            yield connection

    @contextmanager
    def locked(self) -> Iterator[Connection]:
        """One transaction. Until it ends no other process makes or closes a trial through `locked`, and
        Optuna makes none: both take the study's row."""
        from optuna.storages._rdb import models
        from sqlalchemy import update

        study = models.StudyModel
        with self.storage.engine.begin() as connection:
            # a write, since SQLite has no lock of a row: its lock of the file comes with the first write
            connection.execute(
                update(study)
                .where(study.study_id == self.study_id)
                .values(study_name=study.study_name)
            )
            yield connection

    def changed(
        self, connection: Connection, after: int, among: Sequence[int]
    ) -> list[StoredTrial]:
        """Return trials made after the one with id `after`, and those with ids `among`, by id.

        Ids rise with time because trials are made under the study's lock.
        """
        from optuna.distributions import json_to_distribution
        from optuna.storages._rdb import models
        from sqlalchemy import and_, or_, select

        trial, attribute, param = (
            models.TrialModel, models.TrialUserAttributeModel, models.TrialParamModel,
        )  # fmt: skip
        condition = and_(
            trial.study_id == self.study_id,
            or_(trial.trial_id > after, trial.trial_id.in_(among)) if among
            else trial.trial_id > after,
        )  # fmt: skip
        # the states first: a trial that is finished by then has all else
        states = select(trial.trial_id, trial.number, trial.state).where(condition)
        known = connection.execute(states.order_by(trial.trial_id)).all()
        if not known:
            return []
        attributes: dict[int, dict[str, Any]] = {}
        attribute_query = select(attribute.trial_id, attribute.key, attribute.value_json)
        for at, key, text in connection.execute(attribute_query.join(trial).where(condition)):
            attributes.setdefault(at, {})[key] = json.loads(text, object_pairs_hook=_shared_keys)
        values: dict[int, dict[str, float]] = {}
        spans: dict[str, BaseDistribution] = {}
        params = select(
            param.trial_id, param.param_name, param.param_value, param.distribution_json
        )
        for at, key, number, text in connection.execute(
            params.join(trial).where(condition).order_by(param.param_id)
        ):
            span = spans.get(text) or spans.setdefault(text, json_to_distribution(text))
            values.setdefault(at, {})[sys.intern(key)] = span.to_external_repr(number)
        return [
            StoredTrial(at, number, state.is_finished(), attributes.get(at, {}), values.get(at, {}))
            for at, number, state in known
        ]

    def create(
        self,
        connection: Connection,
        first: int,
        trials: Sequence[tuple[Mapping[str, Any], Values]],
        over: Mapping[str, BaseDistribution],
    ) -> list[int]:
        """Create RUNNING trials, numbered from `first`, of (attributes, values), under the lock; return their
        ids."""
        from optuna.distributions import distribution_to_json
        from optuna.storages._rdb import models
        from optuna.trial import TrialState
        from sqlalchemy import insert, select

        trial, now = models.TrialModel.__table__, _now()
        numbers = range(first, first + len(trials))
        new = [
            {
                "number": n, "study_id": self.study_id, "state": TrialState.RUNNING,
                "datetime_start": now,
            }
            for n in numbers
        ]  # fmt: skip
        connection.execute(insert(trial), new)
        made = (
            select(trial.c.trial_id)
            .where(trial.c.study_id == self.study_id)
            .order_by(trial.c.trial_id.desc())
            .limit(len(trials))
        )
        ids = sorted(connection.scalars(made))
        self._attributes(connection, {at: a for at, (a, _) in zip(ids, trials, strict=True)})
        distributions = {key: distribution_to_json(span) for key, span in over.items()}
        params = [
            {
                "trial_id": at, "param_name": key, "distribution_json": distributions[key],
                "param_value": over[key].to_internal_repr(value),
            }
            for at, (_, values) in zip(ids, trials, strict=True)
            for key, value in values.items()
        ]  # fmt: skip
        if params:
            connection.execute(insert(models.TrialParamModel.__table__), params)
        return ids

    def close(
        self,
        connection: Connection,
        trials: Mapping[int, tuple[Mapping[str, Any], Sequence[float] | None]],
    ) -> set[int]:
        """Give trials by id their last attributes and their objectives, or none: these failed.

        Those that another process closed before stay as they are; the ids of the others. Under the lock.
        """
        from optuna.storages._rdb import models
        from optuna.trial import TrialState
        from sqlalchemy import bindparam, insert, select, update

        trial, value = models.TrialModel.__table__, models.TrialValueModel
        still = select(trial.c.trial_id).where(
            trial.c.trial_id.in_(trials), trial.c.state == TrialState.RUNNING
        )
        ids = set(connection.scalars(still))
        if not ids:
            return ids
        self._attributes(connection, {at: trials[at][0] for at in ids})
        objectives = []
        for at in sorted(ids):
            for i, number in enumerate(trials[at][1] or ()):
                stored, kind = value.value_to_stored_repr(number)
                objectives.append(
                    {"trial_id": at, "objective": i, "value": stored, "value_type": kind}
                )
        if objectives:
            connection.execute(insert(value.__table__), objectives)
        closed = (
            update(trial).where(trial.c.trial_id == bindparam("at"))
            .values(state=bindparam("ended"), datetime_complete=_now())
        )  # fmt: skip
        states = {
            at: TrialState.FAIL if trials[at][1] is None else TrialState.COMPLETE for at in ids
        }
        connection.execute(closed, [{"at": at, "ended": states[at]} for at in sorted(ids)])
        return ids

    def _attributes(
        self, connection: Connection, of_trials: Mapping[int, Mapping[str, Any]]
    ) -> None:
        from optuna.storages._rdb import models
        from sqlalchemy import insert

        rows = [
            {"trial_id": at, "key": key, "value_json": json.dumps(value)}
            for at, attributes in of_trials.items()
            for key, value in attributes.items()
        ]
        if rows:
            connection.execute(insert(models.TrialUserAttributeModel.__table__), rows)


def _shared_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A table whose keys are one object each in all rows: half the memory of 100,000 of them."""
    return {sys.intern(key): value for key, value in pairs}


def _now() -> datetime:
    """As Optuna stores times: UTC without its name."""
    return datetime.now(UTC).replace(tzinfo=None)
