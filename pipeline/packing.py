"""Values as bytes without pickles: one .npz of arrays, and a JSON text for the rest.

Reading makes dataclasses of this package and runs nothing else.
"""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from importlib import import_module
from typing import Any

import numpy as np

PACKAGE = __name__.partition(".")[0] + "."
"""Before the name of every module whose dataclasses may be packed."""


def packed(value: Any) -> bytes:
    """Pack arrays, dataclasses of this package, mappings, sequences, bytes and plain values, nested."""
    arrays: dict[str, np.ndarray] = {}
    text = json.dumps(_encode(value, arrays)).encode()
    data = io.BytesIO()
    np.savez(data, **arrays, json=np.frombuffer(text, np.uint8))  # type: ignore[arg-type]
    return data.getvalue()


def unpacked(data: bytes) -> Any:
    """Return what was packed; sequences come as tuples.

    Raises
    ------
    Exception : of any kind that a zip, numpy or JSON reader raises on damaged bytes.
    """
    with np.load(io.BytesIO(data), allow_pickle=False) as entry:
        arrays = {name: entry[name] for name in entry.files}  # zip checks its CRCs here
    text = json.loads(arrays.pop("json").tobytes().decode())
    return _decode(text, arrays)


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
        return {"type": _name(type(value)), "fields": named}
    if isinstance(value, Mapping):
        return {"type": "dict", "fields": {k: _encode(v, arrays) for k, v in value.items()}}
    if isinstance(value, list | tuple):
        return [_encode(v, arrays) for v in value]
    return value


def _decode(text: Any, arrays: Mapping[str, np.ndarray]) -> Any:
    if isinstance(text, list):
        return tuple(_decode(v, arrays) for v in text)
    if not isinstance(text, dict):
        return text
    if "array" in text:
        return arrays[text["array"]]
    if "bytes" in text:
        return arrays[text["bytes"]].tobytes()
    values = {k: _decode(v, arrays) for k, v in text["fields"].items()}
    return values if text["type"] == "dict" else _named(text["type"])(**values)


def _name(kind: type) -> str:
    return f"{kind.__module__}:{kind.__name__}"


def _named(name: str) -> type:
    """The dataclass of that `_name`; any other is refused."""
    module, _, attribute = name.partition(":")
    kind = getattr(import_module(module), attribute) if module.startswith(PACKAGE) else None
    if not (isinstance(kind, type) and is_dataclass(kind) and _name(kind) == name):
        raise ValueError(f"{name} is not a dataclass of this package")
    return kind
