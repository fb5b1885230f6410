"""The solid model's K beside the enclosure of the same part: which is believed, and when neither may be."""

from __future__ import annotations

import pytest

from flexspline.fea.types import Shortfall, Stiffness
from flexspline.pipeline.attempts import Attempts
from flexspline.pipeline.enclosure import held_within
from flexspline.pipeline.errors import NestingError

TOLERANCE = 0.005
NO_TIME = "the next mesh would end too late"


def solid(K: float, half: float, words: str = "") -> Stiffness:
    short = Shortfall(words)
    return Stiffness(K, K - half, K + half, False, "solid", "1/12", "estimate", (), 1.0, short)


def enclosure(low: float, high: float, guaranteed: bool = True) -> Stiffness:
    K = (low + high) / 2
    return Stiffness(K, low, high, guaranteed, "axisymmetric", "two bodies", "theorem", ())


def test_a_narrow_enclosure_bounds_k() -> None:
    """Within the tolerance its ends are the bounds, even where the solid model claims narrower ones."""
    found = held_within(solid(1001.0, 0.5), enclosure(998.0, 1002.0), TOLERANCE)
    assert (found.K_Nm_per_rad, found.bounds_Nm_per_rad) == (1001.0, (998.0, 1002.0))
    assert found.guaranteed
    assert found.proven_Nm_per_rad is None  # the bounds themselves are
    assert found.model == "solid"
    assert "theorem" in found.method


@pytest.mark.parametrize(("K", "held"), [(1002.2, 1001.6), (997.9, 998.45)])
def test_k_outside_the_enclosure_is_moved_to_the_middle_of_what_both_leave(
    K: float, held: float
) -> None:
    """The solid model says K ± 1: from 1001.2 on, and up to 998.9; the enclosure's own end is no answer."""
    found = held_within(solid(K, 1.0), enclosure(998.0, 1002.0), TOLERANCE)
    assert found.K_Nm_per_rad == pytest.approx(held)
    assert found.bounds_Nm_per_rad == (998.0, 1002.0)
    assert "in common" in found.method


def test_a_coarse_solid_leaves_the_middle() -> None:
    found = held_within(solid(1001.5, 9.0, NO_TIME), enclosure(998.0, 1002.0), TOLERANCE)
    assert found.K_Nm_per_rad == 1000.0
    assert not found.shortfall  # the enclosure meets the tolerance


def test_a_wide_enclosure_leaves_each_end_to_the_better() -> None:
    found = held_within(solid(1008.0, 4.0), enclosure(980.0, 1010.0), TOLERANCE)
    assert found.bounds_Nm_per_rad == (1004.0, 1010.0)
    assert found.K_Nm_per_rad == 1008.0
    assert not found.guaranteed
    assert found.proven_Nm_per_rad == (980.0, 1010.0)
    assert found.times(2.0).proven_Nm_per_rad == (1960.0, 2020.0)
    wide = enclosure(980.0, 1010.0, guaranteed=False)
    assert held_within(solid(1008.0, 4.0), wide, TOLERANCE).proven_Nm_per_rad is None


def test_where_both_are_wide_the_narrower_bounds() -> None:
    found = held_within(solid(1000.0, 60.0, NO_TIME), enclosure(980.0, 1010.0), TOLERANCE)
    assert found.bounds_Nm_per_rad == (980.0, 1010.0)
    assert found.guaranteed
    assert found.shortfall.words == NO_TIME


def test_estimates_do_not_become_theorems() -> None:
    assert not held_within(
        solid(1000.0, 9.0), enclosure(998.0, 1002.0, guaranteed=False), TOLERANCE
    ).guaranteed


@pytest.mark.parametrize("K", [900.0, 1100.0])
def test_a_solid_outside_its_enclosure_stops_the_program(K: float) -> None:
    """It is no figure that failed, so the other figures are not given beside it."""
    tried = Attempts()
    with pytest.raises(NestingError, match="wrong") as caught:
        tried.get("K_b", lambda: held_within(solid(K, 9.0), enclosure(998.0, 1002.0), TOLERANCE))
    assert caught.value.softer_Nm_per_rad > caught.value.stiffer_Nm_per_rad
    assert not tried.missing
