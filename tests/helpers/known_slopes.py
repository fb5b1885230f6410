"""A design's slopes, computed by the first test that asks and read by the others, on whichever worker.

They are kept in no cache of the program's, and take ten seconds.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable
from functools import wraps
from hashlib import sha256
from pathlib import Path

import pytest
from finished_run import one_at_a_time

from flexspline.geometry.design import Design
from flexspline.pipeline.study.sensitivity import Slope, sensitivities

Slopes = tuple[Slope, ...]


def once_in_a_suite(place: str, suite: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`place`, a dotted name of `sensitivities`, from here on asks `suite`, the suite's folder, first."""
    monkeypatch.setattr(place, _kept(suite))


def _kept(suite: Path) -> Callable[[Design, Callable[[str], None]], Slopes]:
    @wraps(sensitivities)
    def slopes(design: Design, say: Callable[[str], None]) -> Slopes:
        key = sha256(design.model_dump_json().encode()).hexdigest()[:16]
        path = suite / f"slopes-{key}.pickle"
        with one_at_a_time(suite / "slopes.lock"):
            if not path.exists():
                path.write_bytes(pickle.dumps(sensitivities(design, say)))
        return pickle.loads(path.read_bytes())

    return slopes
