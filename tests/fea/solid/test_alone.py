"""Large models wait for each other; small ones for none."""

from __future__ import annotations

from threading import Event, Thread

import pytest

from flexspline.fea.solid.alone import LARGE, alone

SOON_S = 0.2
"""Until a thread that waits is taken to wait: one that does not passes in microseconds."""
LATE_S = 30.0


@pytest.mark.parametrize(
    ("first", "second", "waits"),
    [(LARGE, LARGE, True), (LARGE, LARGE - 1, False), (LARGE - 1, LARGE, False)],
)
def test_one_large_model_at_a_time(first: int, second: int, waits: bool) -> None:
    entered = Event()

    def work() -> None:
        with alone(second):
            entered.set()

    thread = Thread(target=work, daemon=True)
    with alone(first):
        thread.start()
        assert entered.wait(SOON_S if waits else LATE_S) is not waits
    assert entered.wait(LATE_S)
    thread.join(LATE_S)


def test_a_model_that_fails_lets_the_next_one_in() -> None:
    with pytest.raises(MemoryError), alone(LARGE):
        raise MemoryError
    entered = Event()

    def work() -> None:
        with alone(LARGE):
            entered.set()

    Thread(target=work, daemon=True).start()
    assert entered.wait(LATE_S)


def test_a_thread_may_enter_twice() -> None:
    def work() -> None:
        with alone(LARGE), alone(LARGE):
            entered.set()

    entered = Event()
    Thread(target=work, daemon=True).start()
    assert entered.wait(LATE_S)
