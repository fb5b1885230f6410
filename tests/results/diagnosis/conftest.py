"""What tests of a diagnosis' files share."""

from __future__ import annotations

import pytest


@pytest.fixture
def nothing_drawn(no_diagnosis_drawn: None) -> None:
    """Neither figures nor reports, two thirds of the command's work: for tests of what it says or stores."""
