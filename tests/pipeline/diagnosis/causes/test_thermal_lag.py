"""Whether a gap follows the temperature late is one thing, its size another: neither may feign the other."""

from __future__ import annotations

from math import exp
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from histories import PREDICTION, sweep

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.causes.thermal_clearance import ThermalClearance
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.sweep.magnitudes.thermal_lag import thermal_lag
from flexspline.results.diagnosis.notes import notes

pytestmark = pytest.mark.usefixtures("causes_only")

PER_KELVIN = -1.0
ROWS, PER_CYCLE, STEP_s = 1200, 120, 3.0
LAG_s = 400.0
SEEDS = range(4)


def slipping_springs(torque: np.ndarray) -> np.ndarray:
    """Torque of two springs, 0.3 and 0.1 of the torque's change, that slip at 1 N·m each."""
    total = np.zeros(len(torque))
    for share in (0.3, 0.1):
        held = 0.0
        for k, change in enumerate(np.diff(torque, prepend=torque[0])):
            held = float(np.clip(held + share * change, -1.0, 1.0))
            total[k] += held
    return total


def warming(seed: int, lag_s: float, folder: Path) -> Diagnosis:
    """A gear with friction that warms up by 15 K in an hour, its gap with it, a lag of `lag_s` behind."""
    rng = np.random.default_rng(seed)
    i = np.arange(ROWS)
    time = STEP_s * i
    torque = 10 * (1 - 4 * np.abs(((i + 0.5) / PER_CYCLE + 0.25) % 1 - 0.5))
    air = 21 + 15 * (1 - np.exp(-time / 1400.0))
    gear = air.copy()
    for k in range(1, ROWS) if lag_s else ():
        gear[k] = gear[k - 1] + (air[k] - gear[k - 1]) * (1 - exp(-STEP_s / lag_s))
    angle = 11.4 * torque + np.sign(torque) * (72.2 + PER_KELVIN * (gear - 20)) / 2
    angle += rng.normal(0, 0.8, ROWS) - 11.343 * slipping_springs(torque)
    rows = zip(time, air + rng.normal(0, 0.03, ROWS), torque, angle, strict=True)
    path = folder / "warm.csv"
    path.write_text(
        "time_s,temperature_C,torque_Nm,angle_arcsec\n"
        + "".join(f"{t:g},{c:.2f},{m:.4f},{a:.2f}\n" for t, c, m, a in rows)
    )
    return diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, 31329.0, 43339.0)


def deviations(found: Diagnosis) -> float:
    (cause,) = (c for c in found.causes if c.id == "thermal_clearance")
    return abs(cause.magnitude - PER_KELVIN) / cause.magnitude_std


def test_no_lag_has_even_odds() -> None:
    """In equal shares of the shapes it had one chance in twenty."""
    cause, rig = ThermalClearance(), FitContext(PREDICTION, sweep())
    shapes = cause.shapes(rig)
    shares = [exp(cause.log_share(s, len(shapes))) for s in shapes]
    assert sum(shares) == pytest.approx(1.0)
    assert [share for shape, share in zip(shapes, shares, strict=True) if not shape["lag_s"]] == [
        0.5
    ]


@pytest.mark.long
@pytest.mark.parametrize("lag_s", [0.0, pytest.param(LAG_s, marks=pytest.mark.long)])
def test_the_size_is_within_its_deviation(lag_s: float, tmp_path: Path) -> None:
    """Of four, chance takes more than one beyond two deviations in one case of seventy. Without lag most were
    beyond, as the record's best lag of 50 to 200 s takes 10 % off the size."""
    beyond = [seed for seed in SEEDS if deviations(warming(seed, lag_s, tmp_path)) > 2]
    assert len(beyond) <= 1, beyond


def test_a_lag_in_the_model_is_said(tmp_path: Path) -> None:
    late = warming(0, LAG_s, tmp_path)
    assert late.sweep is not None
    lag = thermal_lag(late.sweep.explained.identified)
    assert lag is not None
    assert lag.shown
    (said,) = (n for n in notes(late) if "with a lag of" in n)
    assert "in the model the gap follows the temperature with a lag of" in said
    assert "nearly as well" not in said


def test_nothing_is_said_of_a_lag_where_there_is_none(tmp_path: Path) -> None:
    prompt = warming(0, 0.0, tmp_path)
    assert prompt.sweep is not None
    lag = thermal_lag(prompt.sweep.explained.identified)
    assert lag is None or not lag.shown
    assert all("nearly as well" in n for n in notes(prompt) if "with a lag of" in n)
