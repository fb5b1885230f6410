"""What a page reads of bytes that `results.page_3d.arrays` packed: a second reader, by numpy."""

from __future__ import annotations

import json
from typing import Any

import numpy as np


def read_arrays(message: bytes) -> dict[str, Any]:
    """The head with its arrays; they must end where the message ends."""
    length = int.from_bytes(message[:4], "little")
    head = json.loads(message[4 : 4 + length])
    at = 4 + length
    for name, kind, shape in head.pop("arrays"):
        head[name] = np.frombuffer(message, kind, int(np.prod(shape)), at).reshape(shape)
        at += -(-head[name].nbytes // 4) * 4
    assert at == len(message)
    return head
