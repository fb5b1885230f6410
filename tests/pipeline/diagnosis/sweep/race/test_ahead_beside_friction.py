"""Friction ahead of the gap beside friction of another kind: the step of the gap says how much it is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

import flexspline

pytestmark = pytest.mark.usefixtures("causes_only")

DESIGN = flexspline.load_design(EXAMPLES / "xb1-40.toml")
COMPLIANCE, GAP, NOISE = 11.387, 72.0, 0.5


def play(torque: np.ndarray, width: float) -> np.ndarray:
    """What a slider that slips at ± width takes of a torque, state 0 at first."""
    state, last, found = 0.0, 0.0, []
    for now in torque:
        state = float(np.clip(state + now - last, -width, width))
        last = now
        found.append(state)
    return np.array(found)


@pytest.mark.parametrize(
    ("ahead", "beside", "cycles"),
    [(0.12, 3.0, 4), pytest.param(0.30, 6.0, 8, marks=pytest.mark.long)],
)
def test_the_friction_ahead_is_found_beside_slipping_springs(
    tmp_path: Path, ahead: float, beside: float, cycles: int
) -> None:
    """Four springs that slip one after another behind the gap bend the loop as friction ahead does.

    Where they bend it twice as much, four cycles do not tell them apart.
    """
    up = np.concatenate([np.linspace(0, 1, 50), np.linspace(1, -1, 100), np.linspace(-1, 0, 50)])
    torque = np.concatenate([a * up for a in (2.0, 1.0, 1.5, 2.0, 1.0, 1.5, 2.0, 2.0)[:cycles]])
    cycle = np.repeat(np.arange(1, cycles + 1), len(up))
    left = torque - play(torque, ahead)
    springs = sum(play(torque, w) / w for w in (0.1, 0.25, 0.45, 0.7)) / 4
    angle = COMPLIANCE * left + GAP / 2 * np.sign(left) - beside * springs
    angle += np.random.default_rng(3).normal(0, NOISE, len(torque))
    rows = zip(cycle, torque, angle, strict=True)
    path = tmp_path / "sweep.csv"
    text = "".join(f"{c},{i},{t:.4f},{a:.3f}\n" for i, (c, t, a) in enumerate(rows))
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    causes = diagnose_file(DESIGN, path, 31_300.0, 43_000.0).causes
    (friction,) = [c for c in causes if c.id == "friction_hysteresis"]
    # rows of the crossing stand 0.02 to 0.04 N·m apart: their half
    assert friction.ahead_Nm == pytest.approx(ahead, abs=0.02)


def test_the_friction_ahead_is_found_beside_a_lag(tmp_path: Path) -> None:
    """A lag opens the loop as friction does: by 27 arcsec in the quick cycles, of 28 by the friction.

    The teeth's twist follows their torque by dθ/dt = (θ∞ − θ)/τ, in steps of a fiftieth of a row.
    """
    ahead, lag_s = 0.4, 6.0
    turn = np.concatenate([np.linspace(0, 2 * np.pi, n, endpoint=False) for n in (120, 240) * 2])
    torque = 2.5 * np.sin(turn)
    cycle = np.repeat(np.arange(1, 5), (120, 240) * 2)
    fine = np.interp(np.arange(0, len(torque) - 1 + 1e-9, 0.02), np.arange(len(torque)), torque)
    left = fine - play(fine, ahead)
    twist, state = np.empty(len(fine)), 0.0
    for k, now in enumerate(COMPLIANCE * left):
        state += 0.02 / lag_s * (now - state)
        twist[k] = state
    angle = (twist + GAP / 2 * np.sign(left))[::50]
    rng = np.random.default_rng(8)
    angle += rng.normal(0, NOISE, len(angle))
    rows = zip(cycle, torque, angle, strict=True)
    path = tmp_path / "sweep.csv"
    text = "".join(f"{c},{i},{t:.4f},{a:.3f}\n" for i, (c, t, a) in enumerate(rows))
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    causes = {c.id: c for c in diagnose_file(DESIGN, path, 31_300.0, 43_000.0).causes}
    assert set(causes) == {"friction_hysteresis", "rate_dependence"}
    # rows of the quick cycles' crossing stand 0.13 N·m apart: their half
    assert causes["friction_hysteresis"].ahead_Nm == pytest.approx(ahead, abs=0.065)
    # the twist behind the rate is c·τ, to what the friction's place leaves of it
    assert causes["rate_dependence"].magnitude == pytest.approx(COMPLIANCE * lag_s, rel=0.1)


@pytest.mark.long
def test_no_lock_that_gives_way_against_the_torque_takes_friction_back(tmp_path: Path) -> None:
    """Such a lock, with a drift, stood beside friction 15 % too large."""
    friction, shift = 0.2, 0.3
    up = np.concatenate([np.linspace(0, 1, 60), np.linspace(1, -1, 120), np.linspace(-1, 0, 60)])
    torque = np.tile(10.0 * up, 5)
    cycle = np.repeat(np.arange(1, 6), len(up))
    left = torque - play(torque, friction)
    angle = COMPLIANCE * left + GAP / 2 * np.sign(left)
    rng = np.random.default_rng(6)
    angle += rng.normal(0, 0.35, len(torque))
    read = torque + shift + rng.normal(0, 0.02, len(torque))
    rows = zip(cycle, read, angle, strict=True)
    path = tmp_path / "sweep.csv"
    text = "".join(f"{c},{i / 2},{t:.4f},{a:.3f}\n" for i, (c, t, a) in enumerate(rows))
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    causes = {c.id: c for c in diagnose_file(DESIGN, path, 31_300.0, 43_000.0).causes}
    assert causes.keys() == {"friction_hysteresis", "torque_offset"}
    assert causes["friction_hysteresis"].magnitude == pytest.approx(
        2 * friction * COMPLIANCE, rel=0.05
    )
    # rows of the crossing stand 0.17 N·m apart: their half
    assert causes["torque_offset"].magnitude == pytest.approx(shift, abs=0.09)
