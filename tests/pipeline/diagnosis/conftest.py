"""What tests of the diagnosis share."""

from __future__ import annotations

import pytest


@pytest.fixture
def causes_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is held out: a fourth of a diagnosis' work, for tests that look at causes, sizes and notes.

    What is held out may only take back a verdict that a cause is found, never a cause, its size or that
    nothing explains the record; that it does not: tests of a verdict "named", and `tests/hidden/`.
    """
    monkeypatch.setattr(
        "flexspline.pipeline.diagnosis.sweep.diagnose.gains_of", lambda *_: (None, ())
    )
