"""Records of three causes that were not named before."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from hidden.adapter import diagnose
from hidden.cases import draw_case
from hidden.mark import mark

from flexspline.geometry.load import load_design

DESIGN = load_design(EXAMPLES / "xb1-40.toml")


@pytest.mark.parametrize(
    ("seed", "number"),
    [
        # creep of 4.4 ± 0.3 %/decade had ± 2.4 from springs that hardening was said to hide
        pytest.param(3000001, 97, marks=pytest.mark.long),
        # a zero of each cycle's own stood for a position error, a drift and an asymmetry
        (12001, 12),
        # friction and a gap that follows the temperature were taken for slow noise
        pytest.param(12001, 55, marks=pytest.mark.long),
        # a sine of 32 rows at uneven times: its bends were torque noise, which hid an offset of 7 %
        pytest.param(12001, 19, marks=pytest.mark.long),
        # a stiffness of three positions left the compliance open, and friction was said to be a spring
        pytest.param(3000001, 89, marks=pytest.mark.long),
    ],
)
def test_three_causes_are_named(seed: int, number: int) -> None:
    assert mark(draw_case(seed, number, "triple"), diagnose).exact


@pytest.mark.usefixtures("causes_only")
def test_a_lag_beside_a_strong_hardening_is_no_trace_of_it(tmp_path: Path) -> None:
    """A Kelvin element of 1 % of the compliance and 8 s beside K1 < K2 < K3, at three rates; the twist of the
    soft wind-up is 40 times the lag's, most of it straight."""
    turn = 1 - 4 * np.abs(((np.arange(240) + 0.5) / 240 + 0.25) % 1 - 0.5)
    torque = 10.0 * np.tile(turn, 6)
    step_s = np.repeat([0.25, 1.0, 4.0] * 2, 240)
    time_s = np.cumsum(step_s)
    soft = 11.343 * (torque + 2.0 * np.tanh(torque / 3.0))
    slow, state = np.empty(len(torque)), 0.0
    for k, now in enumerate(0.01 * 11.343 * torque):
        state = now + (state - now) * np.exp(-step_s[k] / 8.0)
        slow[k] = state
    angle = soft + slow + 36.1 * np.sign(torque)
    angle += np.random.default_rng(4).normal(0, 0.1, len(torque))
    path = tmp_path / "rig.csv"
    rows = zip(np.repeat(np.arange(1, 7), 240), time_s, torque, angle, strict=True)
    path.write_text(
        "cycle,time_s,torque_Nm,angle_arcsec\n"
        + "".join(f"{c},{t:.2f},{q:.4f},{a:.4f}\n" for c, t, q, a in rows)
    )
    causes = {c.id: c for c in diagnose_file(DESIGN, path, 31_329.0, 43_339.0).causes}
    assert causes.keys() >= {"stiffness_hardening", "rate_dependence"}
