"""What tests of a diagnosis' files share."""

from __future__ import annotations

import pytest


@pytest.fixture
def nothing_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither figures nor reports, two thirds of the command's work: for tests of what it says or stores."""
    files = "flexspline.results.diagnosis.files"
    monkeypatch.setattr(f"{files}.draw_figures", lambda *_: ())
    monkeypatch.setattr(f"{files}.reports_of", lambda *_, **__: {})
