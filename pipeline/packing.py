"""Values as bytes without pickles: one .npz of arrays, and a JSON text for the rest.

Reading runs nothing: only the dataclasses that the reader names are made.
"""

from __future__ import annotations

import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np


def packed(value: Any) -> bytes:
    """Arrays, dataclasses, mappings, sequences, bytes and plain values, nested at will."""
    arrays: dict[str, np.ndarray] = {}
    text = json.dumps(_encode(value, arrays)).encode()
    data = io.BytesIO()
    np.savez(data, **arrays, json=np.frombuffer(text, np.uint8))  # type: ignore[arg-type]
    return data.getvalue()


def unpacked(data: bytes, types: Sequence[type]) -> Any:
    """What was packed; sequences come as tuples. `types`: the dataclasses that may stand in it.

    Raises
    ------
    Exception : of any kind that a zip, numpy or JSON reader raises on damaged bytes.
    """
    with np.load(io.BytesIO(data), allow_pickle=False) as entry:
        arrays = {name: entry[name] for name in entry.files}  # zip checks its CRCs here
    text = json.loads(arrays.pop("json").tobytes().decode())
    return _decode(text, arrays, {t.__name__: t for t in types})


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
    if isinstance(value, list | tuple):
        return [_encode(v, arrays) for v in value]
    return value


def _decode(text: Any, arrays: Mapping[str, np.ndarray], types: Mapping[str, type]) -> Any:
    if isinstance(text, list):
        return tuple(_decode(v, arrays, types) for v in text)
    if not isinstance(text, dict):
        return text
    if "array" in text:
        return arrays[text["array"]]
    if "bytes" in text:
        return arrays[text["bytes"]].tobytes()
    values = {k: _decode(v, arrays, types) for k, v in text["fields"].items()}
    return values if text["type"] == "dict" else types[text["type"]](**values)
