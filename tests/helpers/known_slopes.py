"""A design's slopes, computed by the first test that asks and read by the others, on whichever worker.

They are kept in no cache of the program's, and take ten seconds.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from pathlib import Path

import pytest
from kept import once

from flexspline.geometry.design import Design
from flexspline.pipeline.study.sensitivity import Slope, sensitivities

Slopes = tuple[Slope, ...]


def once_in_a_suite(place: str, suite: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`place`, a dotted name of `sensitivities`, from here on asks `suite`, the suite's folder, first."""
    monkeypatch.setattr(place, _kept(suite))


def _kept(suite: Path) -> Callable[[Design, Callable[[str], None]], Slopes]:
    @wraps(sensitivities)
    def slopes(design: Design, say: Callable[[str], None]) -> Slopes:
        asked = f"slopes {design.model_dump_json()}"
        return once(suite, asked, lambda: sensitivities(design, say))

    return slopes
