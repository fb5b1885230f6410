"""Arrays as bytes for a page.

The length of a JSON head (uint32, little endian), the head padded to four bytes, then the arrays that it
lists, little endian, each padded to four bytes. `arrays.js` reads them.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np


def packed(head: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> bytes:
    """uint16 stays, other whole numbers become uint32, all others float32."""
    kinds = {name: _kind(array) for name, array in arrays.items()}
    listed = [[name, kinds[name], list(array.shape)] for name, array in arrays.items()]
    text = json.dumps({**head, "arrays": listed}, allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    body = b"".join(
        _padded(np.ascontiguousarray(array, np.dtype(kinds[name]).newbyteorder("<")).tobytes())
        for name, array in arrays.items()
    )
    return len(text).to_bytes(4, "little") + text + body


def _kind(array: np.ndarray) -> str:
    if array.dtype == np.uint16:
        return "uint16"
    return "uint32" if array.dtype.kind in "iu" else "float32"


def _padded(data: bytes) -> bytes:
    return data + b"\0" * (-len(data) % 4)
