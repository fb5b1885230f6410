"""Friction whose loop has square ends, and rate dependence: one is not named for the other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from histories import PREDICTION

import flexspline
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.causes.square_loop import SQUARE
from flexspline.pipeline.diagnosis.measurement.history import History

pytestmark = pytest.mark.usefixtures("causes_only")

DESIGN = flexspline.load_design(EXAMPLES / "xb1-40.toml")
WIDTH_arcsec = 6.0


def record(path: Path, rows_per_cycle: int, seconds: tuple[float, ...]) -> Path:
    """Ten cycles of a sine of ± 2 N·m, read with 0.5 % of noise; the angle jumps where torque turns."""
    rng = np.random.default_rng(1)
    share = np.arange(rows_per_cycle) / rows_per_cycle
    torque = np.tile(2 * np.sin(2 * np.pi * share), 10)
    way = np.tile(np.sign(np.cos(2 * np.pi * share)), 10)
    cycle = np.repeat(np.arange(10), rows_per_cycle)
    lasts = np.array([seconds[c % len(seconds)] for c in range(10)])
    time = np.concatenate([[0.0], np.cumsum(lasts)])[cycle] + np.tile(share, 10) * lasts[cycle]
    angle = 11.5 * torque + 36 * np.sign(torque) - WIDTH_arcsec / 2 * way
    angle += rng.normal(0, 0.4, len(torque))
    read = torque + rng.normal(0, 0.01, len(torque))
    lines = (
        f"{t:.3f},{c + 1},{r:.5f},{a:.3f}"
        for t, c, r, a in zip(time, cycle, read, angle, strict=True)
    )
    path.write_text(
        "\n".join(["time_s,cycle,torque_Nm,angle_arcsec", *lines]) + "\n", encoding="utf-8"
    )
    return path


ONE_RATE, THREE_RATES = (180.0,), (180.0, 540.0, 54.0)


@pytest.mark.parametrize(
    ("rows_per_cycle", "seconds"),
    [
        (100, THREE_RATES),
        *(
            pytest.param(*case, marks=pytest.mark.long)
            for case in ((100, ONE_RATE), (300, ONE_RATE), (300, THREE_RATES))
        ),
    ],
)
def test_a_square_loop_is_friction(
    rows_per_cycle: int, seconds: tuple[float, ...], tmp_path: Path
) -> None:
    """A rate's power of 0.4 was nearest to it, and was named beyond doubt."""
    found = diagnose_file(DESIGN, record(tmp_path / "m.csv", rows_per_cycle, seconds), 31377, 43275)
    causes = {c.id: c for c in found.causes}
    assert "rate_dependence" not in causes
    size = causes["friction_hysteresis"]
    # five deviations of 0.4 arcsec in 50 rows about T = 0
    assert size.magnitude == pytest.approx(WIDTH_arcsec, abs=0.3)


def test_where_torque_rests_the_loop_turns_at_the_end_of_the_rest() -> None:
    """Friction does not turn while torque is held, whatever its reading's noise says."""
    up, rest = np.linspace(-2, 2, 80), np.full(40, 2.0)
    true = np.concatenate([up, rest, up[::-1], -rest] * 3)
    read = true + np.random.default_rng(4).normal(0, 0.01, len(true))
    none = np.zeros(len(true), int)
    history = History(read, none, none, np.arange(len(true), dtype=float))
    friction = known_causes()["friction_hysteresis"]
    (shape,) = (
        s for s in friction.shapes(FitContext(PREDICTION, history)) if s.get(SQUARE) and s["held"]
    )
    column = friction.columns(shape, history)[:, 0]
    way = np.sign(np.diff(true, append=true[-1]))
    for rests in (np.arange(k + 85, k + 115) for k in range(0, len(true) - 240, 240)):
        assert (column[rests] == -1).all()
    moving = np.flatnonzero(way[1:] * way[:-1] > 0)
    wrong = column[moving] != -way[moving]
    assert wrong.mean() < 0.03  # rows beside the ends of the rests
