"""What several tests ask for, computed by the first of them and read by the others, on whichever worker."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import TypeVar

from finished_run import one_at_a_time

T = TypeVar("T")


def once(suite: Path, asked: str, make: Callable[[], T]) -> T:
    """What `make` gives; `asked` says all that it depends on, `suite` is the folder of this suite's run."""
    path = suite / "kept" / f"{sha256(asked.encode()).hexdigest()}.pickle"
    path.parent.mkdir(exist_ok=True)
    with one_at_a_time(path.with_suffix(".lock")):
        if not path.exists():
            path.write_bytes(pickle.dumps(make()))
    return pickle.loads(path.read_bytes())
