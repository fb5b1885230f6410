"""Results kept by the content of what made them: the same question is answered once.

fTetWild is not deterministic, so the cache is also what makes a part that it meshes give the same answer
twice.
An entry is one .npz: arrays, and a JSON text for the rest. Damaged entries are dropped and made anew.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import shutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from pipeline.leftovers import discard, unfinished

T = TypeVar("T")
FORMAT = 8
"""Raise when what a stage means changes, so that old entries are not read."""


@dataclass(frozen=True)
class Cache:
    """Entries below `folder`; `types` are the dataclasses that may stand in one."""

    folder: Path
    types: tuple[type, ...]
    notice: Callable[[str], None] = print

    def get(self, stage: str, inputs: Mapping[str, Any], make: Callable[[], T]) -> tuple[T, bool]:
        """The stored value for `inputs`, or `make()`'s, then stored; and whether it was stored."""
        key = content_key({"format": FORMAT, "stage": stage, **inputs})
        path = self.folder / stage / f"{key}.npz"
        found = self._read(path, key)
        if found is not _MISSING:
            return found, True
        discard(path.parent, self.notice)
        value = make()
        self._write(path, key, value)
        return value, False

    def _read(self, path: Path, key: str) -> Any:
        try:
            data = path.read_bytes()
        except (FileNotFoundError, NotADirectoryError):
            return _MISSING
        except OSError as error:
            self._discard(path, error)
            return _MISSING
        try:
            with np.load(io.BytesIO(data), allow_pickle=False) as entry:
                arrays = {name: entry[name] for name in entry.files}  # zip checks its CRCs here
            stored = json.loads(arrays.pop("json").tobytes().decode())
            if stored["key"] != key:
                raise ValueError("the answer to another question")
            return self._decode(stored["value"], arrays)
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

    def _write(self, path: Path, key: str, value: Any) -> None:
        arrays: dict[str, np.ndarray] = {}
        text = json.dumps({"key": key, "value": _encode(value, arrays)}).encode()
        data = io.BytesIO()
        np.savez(data, **arrays, json=np.frombuffer(text, np.uint8))  # type: ignore[arg-type]
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            made = unfinished(path.parent, data.getvalue())
            try:
                os.replace(made, path)
            finally:
                made.unlink(missing_ok=True)
        except OSError as error:
            self.notice(f"could not store a result in {path.parent}: {error.strerror}")

    def _decode(self, text: Any, arrays: Mapping[str, np.ndarray]) -> Any:
        if isinstance(text, list):
            return tuple(self._decode(v, arrays) for v in text)
        if not isinstance(text, dict):
            return text
        if "array" in text:
            return arrays[text["array"]]
        if "bytes" in text:
            return arrays[text["bytes"]].tobytes()
        values = {k: self._decode(v, arrays) for k, v in text["fields"].items()}
        if text["type"] == "dict":
            return values
        known = {t.__name__: t for t in self.types}
        return known[text["type"]](**values)


_MISSING: Any = object()


def content_key(inputs: Mapping[str, Any]) -> str:
    """SHA-256 of the inputs' canonical JSON; floats enter with all their digits."""
    text = json.dumps(inputs, sort_keys=True, separators=(",", ":"), default=_plain)
    return hashlib.sha256(text.encode()).hexdigest()[:40]


def _plain(value: Any) -> Any:
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: getattr(value, f.name) for f in fields(value)}
    if hasattr(value, "model_dump"):
        return value.model_dump(mode="json")
    raise TypeError(f"{type(value).__name__} cannot be part of a cache key")


def _encode(value: Any, arrays: dict[str, np.ndarray]) -> Any:
    if isinstance(value, np.ndarray):
        name = f"a{len(arrays)}"
        arrays[name] = value
        return {"array": name}
    if isinstance(value, bytes):
        name = f"a{len(arrays)}"
        arrays[name] = np.frombuffer(value, np.uint8)
        return {"bytes": name}
    if isinstance(value, np.generic):
        return value.item()
    if is_dataclass(value) and not isinstance(value, type):
        named = {f.name: _encode(getattr(value, f.name), arrays) for f in fields(value)}
        return {"type": type(value).__name__, "fields": named}
    if isinstance(value, Mapping):
        return {"type": "dict", "fields": {k: _encode(v, arrays) for k, v in value.items()}}
    if isinstance(value, (list, tuple)):
        return [_encode(v, arrays) for v in value]
    return value
