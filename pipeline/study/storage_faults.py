"""What a study's database and its libraries raise, as one error in plain words."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from flexspline.geometry.errors import ComputationError, one_line

DAMAGED = ("disk image is malformed", "file is not a database")
"""SQLite's words for a file that no second attempt reads."""


class TrialStoreError(ComputationError):
    """The storage of a study does not work: a full disk, a damaged file, a database gone."""

    def __init__(self, reason: str) -> None:
        helps = "what is stored is kept: run the same command again to resume"
        if any(words in reason for words in DAMAGED):
            helps = "the file is damaged: move it away, or name another folder with --out"
        super().__init__(f"the study's storage does not work: {reason}; {helps}")


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
