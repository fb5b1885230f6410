"""What a study's database and its libraries raise, as one error in plain words."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager

from flexspline.geometry.errors import ComputationError, one_line

RESUME = "what is stored is kept: run the same command again to resume"
DAMAGED = "the file (study.db where run.storage names none) is damaged: move it away, or choose another --out"
DAMAGES = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)


class TrialStoreError(ComputationError):
    """The storage of a study does not work: a full disk, a damaged file, a database gone."""

    def __init__(self, reason: str, helps: str = RESUME) -> None:
        super().__init__(f"the study's storage does not work: {reason}; {helps}")


@contextmanager
def storage_faults() -> Iterator[None]:
    """What the database and its libraries raise, as a TrialStoreError."""
    from optuna.exceptions import StorageInternalError
    from sqlalchemy.exc import SQLAlchemyError

    try:
        yield
    except (SQLAlchemyError, StorageInternalError) as fault:
        raise TrialStoreError(said(fault), helps(fault)) from fault


def said(fault: BaseException) -> str:
    """The database's own words, without the statement and its values."""
    fault = _first(fault)
    return one_line((str(fault) or type(fault).__name__).splitlines()[0])


def is_damaged(fault: BaseException) -> bool:
    """Whether it is SQLite's word that the file is none of its own, or no longer: no try will do better."""
    code = getattr(_first(fault), "sqlite_errorcode", 0)
    return code & 0xFF in DAMAGES  # above the lowest byte: details


def helps(fault: BaseException) -> str:
    """What the user can do."""
    return DAMAGED if is_damaged(fault) else RESUME


def _first(fault: BaseException) -> BaseException:
    while isinstance(fault.__cause__, Exception):
        fault = fault.__cause__
    return fault
