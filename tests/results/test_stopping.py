"""A command that is asked to end says so at once, though its step takes longer."""

import signal
import time
from collections.abc import Iterator

import pytest

from flexspline.results.stopping import AT_ONCE_S, answered_at_once


@pytest.fixture(autouse=True)
def _deaf() -> Iterator[None]:
    """A main thread that does not hear of SIGTERM, as within a call into a library."""
    before = signal.signal(signal.SIGTERM, lambda number, frame: None)
    yield
    signal.signal(signal.SIGTERM, before)


@pytest.mark.parametrize(("seconds", "lines"), [(2 * AT_ONCE_S, 1), (0.0, 0)])
def test_one_line_where_the_step_goes_on(
    seconds: float, lines: int, capsys: pytest.CaptureFixture[str]
) -> None:
    with answered_at_once():
        signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGTERM)
        time.sleep(seconds)
    assert capsys.readouterr().err.count("flexspline: stopping after the current step") == lines


def test_nothing_is_said_of_a_command_that_nobody_stops(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with answered_at_once():
        time.sleep(2 * AT_ONCE_S)
    assert capsys.readouterr().err == ""
