"""Cache of results by the content of their inputs: the same input is computed once.

fTetWild is not deterministic, so the cache is also what makes a part that it meshes give the same answer
twice.
An entry is one .npz (`pipeline.packing`). Damaged entries are dropped and made again. Pickles are passed
only between copies of one process, in a temporary folder of theirs (`fea/process_lock.py`).
"""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import shutil
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from threading import Lock
from typing import Any, TypeVar

from flexspline.fea.process_lock import ProcessLock, shared_folder
from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.packing import packed, unpacked
from flexspline.pipeline.temporary_files import discard, unfinished, write_unfinished

T = TypeVar("T")
PLACE_DIGITS = 12
"""Hexadecimal ones of a key that tell its lock's place in a file: two of a thousand keys share one once in
5e8 times, and wait for each other."""
FORMAT = 33
"""Raise when what a stage means changes, so that old entries are not read."""


class KeyedLocks:
    """One lock for each key. A value asks only for values of earlier stages, so none waits in a circle."""

    def __init__(self) -> None:
        self._own = Lock()
        self._locks: dict[str, ProcessLock] = {}

    def __getitem__(self, key: str) -> ProcessLock:
        with self._own:
            return self._locks.setdefault(key, ProcessLock(1 + int(key[:PLACE_DIGITS], 16)))


def _shared(key: str) -> Path | None:
    """Where a copy of this process looks for what is not for the disk, or failed."""
    folder = shared_folder()
    return None if folder is None else folder / key


def _is_first(why: str) -> bool:
    """Whether no copy of this process has said so yet."""
    mark = _shared(hashlib.sha256(why.encode()).hexdigest())
    if mark is None:
        return True
    try:
        mark.touch(exist_ok=False)
    except OSError as fault:  # without room twice is better than never
        return not isinstance(fault, FileExistsError)
    return True


def _taken(path: Path) -> Any:
    """What a copy of this process made, or _MISSING."""
    try:
        return pickle.loads(path.read_bytes())
    except Exception:  # not there, or not to be made again: then it is made here
        return _MISSING


def _given(path: Path | None, value: Any) -> None:
    """Leave a value to the copies of this process, where there are any."""
    if path is not None:
        with suppress(Exception):  # no room, or no pickle: the copy makes its own
            path.write_bytes(pickle.dumps(value))


@dataclass(frozen=True)
class Cache:
    """A cache of entries below `folder`."""

    folder: Path
    notice: Callable[[str], None] = print
    failed: dict[str, ComputationError] = field(default_factory=dict, compare=False)
    """What failed since this object was made, by key: nobody waits for the same failure twice."""
    passing: dict[str, Any] = field(default_factory=dict, compare=False)
    """What is not for the disk, or found no room there, by key."""
    locks: KeyedLocks = field(default_factory=KeyedLocks, compare=False)
    """Held while a value is made, by key."""
    notices: set[str] = field(default_factory=set, compare=False)
    """Why results could not be stored: each reason is said once."""

    def get(
        self,
        stage: str,
        inputs: Mapping[str, Any],
        make: Callable[[], T],
        is_lasting: Callable[[T], bool] = lambda _: True,
    ) -> tuple[T, bool]:
        """Return the stored value for `inputs`, or `make()`'s, then stored; and whether it was stored.

        A value that is not lasting is kept as long as this object and not on disk: another run may do better.
        Of two threads that ask for one value, or of a process and its copy, the second waits for the first.

        Raises
        ------
        ComputationError : from `make`, now or when it was asked before.
        """
        key = self._key(stage, inputs)
        with self.locks[key]:
            return self._got(stage, key, make, is_lasting)

    def _got(
        self, stage: str, key: str, make: Callable[[], T], is_lasting: Callable[[T], bool]
    ) -> tuple[T, bool]:
        path = self._path(stage, key)
        stored = self._read(path, key)
        if stored is not _MISSING:
            return stored, True
        discard(path.parent, self.notice)
        if key in self.failed:
            raise self.failed[key]
        if key in self.passing:
            return self.passing[key], True
        if (shared := _shared(key)) is not None and (stored := _taken(shared)) is not _MISSING:
            if isinstance(stored, ComputationError):
                self.failed[key] = stored
                raise stored
            self.passing[key] = stored
            return stored, True
        try:
            value = make()
        except ComputationError as fault:
            self.failed[key] = fault
            _given(shared, fault)
            raise
        if not (is_lasting(value) and self._written(path, key, value)):
            self.passing[key] = value
            _given(shared, value)
        return value, False

    def has(self, stage: str, inputs: Mapping[str, Any]) -> bool:
        """Whether a value for `inputs` is stored; `get` may yet find it damaged."""
        return os.path.exists(
            self._path(stage, self._key(stage, inputs))
        )  # False too where it may not look

    @staticmethod
    def _key(stage: str, inputs: Mapping[str, Any]) -> str:
        return content_key({"format": FORMAT, "stage": stage, **inputs})

    def _path(self, stage: str, key: str) -> Path:
        return self.folder / stage / f"{key}.npz"

    def _read(self, path: Path, key: str) -> Any:
        try:
            data = path.read_bytes()
        except (FileNotFoundError, NotADirectoryError):
            return _MISSING
        except OSError as error:
            self._discard(path, error)
            return _MISSING
        try:
            stored = unpacked(data)
            if stored["key"] != key:
                raise ValueError("the answer to another question")
            return stored["value"]
        except Exception as error:  # bytes that anything may have happened to: any reader may choke
            self._discard(path, error)
            return _MISSING

    def _discard(self, path: Path, error: Exception) -> None:
        self.notice(f"discarded a damaged cache entry {path.name} ({type(error).__name__})")
        try:
            if path.is_dir():
                shutil.rmtree(path)
            else:
                path.unlink(missing_ok=True)
        except OSError as fault:
            self.notice(f"could not remove it: {fault.strerror}")

    def _written(self, path: Path, key: str, value: Any) -> bool:
        data = packed({"key": key, "value": value})
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            made = unfinished(path.parent)
            try:
                write_unfinished(made, data)
                os.replace(made, path)
            finally:
                made.unlink(missing_ok=True)
        except OSError as error:
            why = f"could not store a result in {self.folder}: {error.strerror}"
            if why not in self.notices:
                self.notices.add(why)
                if _is_first(why):
                    self.notice(f"{why}; FLEXSPLINE_CACHE names another folder")
            return False
        return True


_MISSING: Any = object()


def content_key(inputs: Mapping[str, Any]) -> str:
    """Return the SHA-256 of the inputs' canonical JSON; floats enter with all their digits."""
    text = json.dumps(inputs, sort_keys=True, separators=(",", ":"), default=_plain)
    # 160 bits: no two inputs ever meet by chance, and names of files stay short
    return hashlib.sha256(text.encode()).hexdigest()[:40]


def _plain(value: Any) -> Any:
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: getattr(value, f.name) for f in fields(value)}
    if hasattr(value, "model_dump"):
        return value.model_dump(mode="json")
    raise TypeError(f"{type(value).__name__} cannot be part of a cache key")
