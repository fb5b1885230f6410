"""What `flexspline diagnose` must reach over effects hidden in made-up measurements."""

from __future__ import annotations

import secrets
from collections.abc import Sequence

import pytest

from hidden.adapter import diagnose
from hidden.cases import draw_case
from hidden.mark import Mark, mark
from hidden.score import breakdown, failures, figures, table

FIXED_SEED = 20


def marks(seed: int, count: int) -> list[Mark]:
    return [mark(draw_case(seed, k), diagnose) for k in range(count)]


def check(found: Sequence[Mark]) -> None:
    """Every demand, less two binomial deviations of a program exactly as good as demanded.

    With few records that allowance is wide (20 singles at 94 %: 11 points); it is there because a
    fixed seed is one draw. The number of records is on the page that a failure prints.
    """
    rows = figures(found)
    # how long it takes is a benchmark's business: a loaded machine fails no test
    missed = [f.name for f in rows if not (f.met(allowed=True) or f.name.startswith("seconds"))]
    assert not missed, "\n".join([table(rows), breakdown(found), failures(found)])


def test_demands_on_fixed_seeds() -> None:
    check(marks(FIXED_SEED, 6))


@pytest.mark.long
def test_demands_on_fresh_seeds() -> None:
    seed = secrets.randbelow(2**31)
    print(f"python tests/hidden/run.py --seed {seed} --records 400")
    check(marks(seed, 400))
