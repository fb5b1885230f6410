"""Errors of a study's database and its libraries, as one error in plain words."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from flexspline.geometry.errors import ComputationError, one_line

if TYPE_CHECKING:
    from sqlalchemy import URL

RESUME = "what is stored is kept: run the same command again to resume"
DAMAGED = "the file (study.db where run.storage names none) is damaged: move it away, or choose another --out"
GONE = (
    "its file was deleted meanwhile, with what was stored: run the same command again to start over"
)
DAMAGES = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)


class TrialStoreError(ComputationError):
    """The storage of a study does not work: a full disk, a damaged file, a database gone."""

    def __init__(self, reason: str, helps: str = RESUME) -> None:
        super().__init__(f"the study's storage does not work: {reason}; {helps}")


@dataclass(frozen=True)
class OpenedFile:
    """A database's file as it was opened: its device and inode."""

    path: Path
    identity: tuple[int, int]

    @classmethod
    def of(cls, url: URL) -> OpenedFile | None:
        """Return the database's file; None where the database is no file."""
        path = Path(url.database or "")
        if url.get_backend_name() != "sqlite" or not path.is_file():
            return None
        return cls(path, _identity(path))

    @property
    def is_gone(self) -> bool:
        """Whether it was deleted; another file under its name holds nothing of it."""
        try:
            return _identity(self.path) != self.identity
        except OSError:
            return True


@contextmanager
def storage_faults(file: OpenedFile | None) -> Iterator[None]:
    """What the database, of that file if any, and its libraries raise, as a TrialStoreError."""
    from optuna.exceptions import StorageInternalError
    from sqlalchemy.exc import SQLAlchemyError

    try:
        yield
    except (SQLAlchemyError, StorageInternalError) as fault:
        gone = file is not None and file.is_gone
        raise TrialStoreError(said(fault), GONE if gone else helps(fault)) from fault


def said(fault: BaseException) -> str:
    """Return the database's own words, without the statement and its values."""
    fault = _first(fault)
    return one_line((str(fault) or type(fault).__name__).splitlines()[0])


def is_damaged(fault: BaseException) -> bool:
    """Whether SQLite says that the file is damaged or no database: no further try will work."""
    code = getattr(_first(fault), "sqlite_errorcode", 0)
    return code & 0xFF in DAMAGES  # above the lowest byte: details


def helps(fault: BaseException) -> str:
    """Return what the user can do."""
    return DAMAGED if is_damaged(fault) else RESUME


def _identity(path: Path) -> tuple[int, int]:
    status = path.stat()
    return status.st_dev, status.st_ino


def _first(fault: BaseException) -> BaseException:
    while isinstance(fault.__cause__, Exception):
        fault = fault.__cause__
    return fault
