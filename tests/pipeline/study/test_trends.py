"""docs/trends.md is what the studies give, and the verdicts are those that the formulas imply."""

import re

import pytest
from trends_page import PAGE, ROWS, page, sweep


def test_the_page_is_what_the_studies_give() -> None:
    """Figures to 1 %, which leaves room for another BLAS; words and verdicts exactly."""
    number = re.compile(r"-?\d+\.\d+")
    written, now = PAGE.read_text(encoding="utf-8"), page()
    assert number.sub("#", written) == number.sub("#", now)
    old, new = ([float(n) for n in number.findall(t)] for t in (written, now))
    assert new == pytest.approx(old, rel=0.01, abs=0.01)


def test_bearing_play_counts_as_one_over_the_teeth() -> None:
    """Δ4 = 2j'/(m z1 cos α) and j' knows z2 − z1 only: the source's "minor effect" does not hold."""
    s = sweep("teeth")
    assert s.terms["play"] * s.x == pytest.approx(s.terms["play"][0] * s.x[0], rel=1e-9)
    (claim,) = (c for c in ROWS["teeth"][2] if c.term == "play")
    assert not claim.holds(s)
