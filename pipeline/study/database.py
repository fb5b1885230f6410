"""Opens or creates a study's database."""

from __future__ import annotations

import logging
import re
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from flexspline.geometry.errors import DesignError
from flexspline.pipeline.process_id import this_process
from flexspline.pipeline.study.storage_faults import OpenedFile, is_damaged, said
from flexspline.pipeline.study.store import TrialStore

if TYPE_CHECKING:
    from optuna.samplers import BaseSampler

LOCK_S = 60
"""How long to wait for another process that writes to the same SQLite file."""
SERVER: dict[str, Any] = {"pool_pre_ping": True}
"""A connection that the server dropped meanwhile is made again."""
OPENINGS = 6
"""Tries, 0.5 s to 2.5 s apart: 7.5 s in all for another process to finish making the tables."""


class StorageError(DesignError):
    """A database that cannot be opened; `url` and why."""

    def __init__(self, url: str, reason: str) -> None:
        self.url, self.cause = url, reason
        shown = re.sub(r"(://[^:/@]*:)[^@]*@", r"\1***@", url)  # without its password
        super().__init__("run.storage", shown, f"cannot be opened: {reason}")


def open_trial_store(
    url: str, name: str, directions: Sequence[str], sampler: BaseSampler
) -> TrialStore:
    """Open the study of that name in a database; it is made if it is not there.

    Raises
    ------
    StorageError : the database cannot be opened.
    """
    import optuna
    from optuna.exceptions import StorageInternalError
    from optuna.storages import RDBStorage
    from sqlalchemy.exc import ArgumentError, SQLAlchemyError

    optuna.logging.set_verbosity(optuna.logging.ERROR)
    # an interrupt during a query: the pool would print how closing the connection failed
    logging.getLogger("sqlalchemy.pool").setLevel(logging.CRITICAL + 1)
    args = {"connect_args": {"timeout": LOCK_S}} if url.startswith("sqlite") else SERVER
    for attempt in range(OPENINGS):
        try:
            storage = RDBStorage(url, engine_kwargs=args)
            trials = optuna.create_study(
                storage=storage,
                study_name=name,
                directions=list(directions),  # type: ignore[arg-type]
                sampler=sampler,
                load_if_exists=True,
            )
            file = OpenedFile.of(storage.engine.url)
            return TrialStore(trials, storage, str(this_process()), file)
        except (SQLAlchemyError, StorageInternalError, ImportError, RuntimeError, OSError) as fault:
            # two processes that make the tables at once: the second finds them on its next try
            again = isinstance(fault, SQLAlchemyError) and not isinstance(fault, ArgumentError)
            again = again and not is_damaged(fault)
            if attempt == OPENINGS - 1 or not again:
                raise StorageError(url, said(fault)) from fault
            time.sleep(0.5 * (attempt + 1))
    raise AssertionError("the last attempt returns or raises")
