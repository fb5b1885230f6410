"""A lock that slips is told from friction, drift and creep, by records made by hand."""

from dataclasses import replace

import numpy as np
import pytest
from histories import sweep

from flexspline.pipeline.diagnosis.sweep.rig_faults.clamp_slip import slip_of

RECORD = sweep(cycles=4, rows=80)
TWIST = 10.0 * RECORD.torque_Nm + 30.0 * np.sign(RECORD.torque_Nm)  # 50 arcsec at 2 N·m


def coulomb(share: float, both: bool = True) -> np.ndarray:
    """(n,) arcsec that a joint slips, one step a row beyond `share` of the largest torque."""
    T = RECORD.torque_Nm
    moves = np.where(2 * share < T, 1.0, np.where((-2 * share > T) & both, -1.0, 0.0))
    return np.cumsum(moves)


def test_slip_under_both_directions_is_seen_and_sized() -> None:
    """A load holds 8 rows at 2 N·m and 3 or 4 rows beyond 80 % on the way up and down: 14 to 16 steps."""
    found = slip_of(RECORD, TWIST + 20 * coulomb(0.8))
    assert found is not None
    assert 14 * 20 <= found.slip_arcsec <= 17 * 20


def test_slip_one_way_only_is_seen() -> None:
    assert slip_of(RECORD, TWIST + 20 * coulomb(0.8, both=False)) is not None


@pytest.mark.parametrize(
    ("name", "added"),
    [
        ("nothing", np.zeros(len(RECORD))),
        ("drift", np.linspace(0, 3000, len(RECORD))),
        ("friction", -25.0 * np.sign(np.gradient(RECORD.torque_Nm))),  # a loop as wide as the twist
        ("noise", np.random.default_rng(0).normal(0, 10, len(RECORD))),
        ("a zero of its own in each cycle", 300.0 * np.array([0, 2, -1, 1])[RECORD.cycle]),
    ],
)
def test_what_does_not_slip(name: str, added: np.ndarray) -> None:
    assert slip_of(RECORD, TWIST + added) is None, name


def test_half_a_cycle_says_nothing() -> None:
    one_way = replace(RECORD, torque_Nm=np.abs(RECORD.torque_Nm))
    assert slip_of(one_way, TWIST) is None
