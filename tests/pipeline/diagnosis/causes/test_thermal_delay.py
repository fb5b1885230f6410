"""A gap that follows the temperature with a delay: a size that the record does not show is unsure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from histories import PREDICTION, sweep

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.causes.thermal_clearance import ThermalClearance
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.nuisance.channel_nuisance import over_temperature

pytestmark = pytest.mark.usefixtures("causes_only")

CUP = EXAMPLES / "xb1-40.toml"
PER_KELVIN, DELAY_s, PERIOD_s = -0.6, 350.0, 2700.0
CAUSE = ThermalClearance()


def swinging(gear: Callable[[np.ndarray], np.ndarray], folder: Path) -> NamedCause:
    """What is named of a record in air that swings by ± 25 K; `gear` gives its temperature less 20 °C."""
    share = np.concatenate([np.arange(50) / 50, 1 - np.arange(100) / 50, np.arange(50) / 50 - 1])
    torque = 10.0 * np.tile(share, 10)
    time = 3.0 * np.arange(len(torque))
    angle = 3.117 * torque + np.sign(torque) * (72.2 + PER_KELVIN * gear(time)) / 2
    angle += np.random.default_rng(1).normal(0, 0.4, len(torque))
    record = folder / "warm.csv"
    rows = zip(time, torque, 20 + warm(time), angle, strict=True)
    text = "".join(f"{t:g},{m:.4f},{c:.4f},{a:.4f}\n" for t, m, c, a in rows)
    record.write_text("time_s,torque_Nm,temperature_C,angle_arcsec\n" + text)
    (found,) = diagnose_file(load_design(CUP), record, 125_274.0, 140_291.0).causes
    assert found.id == "thermal_clearance"
    return found


def warm(t: np.ndarray) -> np.ndarray:
    """Air less 20 °C [K], which has swung before the record as well."""
    return 25.0 * np.sin(2 * np.pi * t / PERIOD_s)


def masses(*constants_s: float) -> Callable[[np.ndarray], np.ndarray]:
    """A gear behind thermal masses, swinging steadily: 1/Π(1 + iωτ) of the air."""
    omega = 2 * np.pi / PERIOD_s
    behind = 1 / np.prod([1 + 1j * omega * tau for tau in constants_s])
    return lambda t: 25.0 * abs(behind) * np.sin(omega * t + np.angle(behind))


def test_lags_that_cancel_each_other_leave_the_size_less_sure(tmp_path: Path) -> None:
    """One frequency shows how far the gap moves at that frequency; at rest it moves by 0.6 arcsec/K. The race
    takes lags of opposite sign for the delay; the size was 3.5 of its deviations off."""
    found = swinging(lambda t: warm(np.maximum(t - DELAY_s, 0.0)), tmp_path)
    assert abs(found.magnitude - PER_KELVIN) < 2 * found.magnitude_std


@pytest.mark.parametrize(
    "constants_s",
    [*(pytest.param((s,), marks=pytest.mark.long) for s in (600.0, 1500.0)), (400.0, 300.0)],
)
def test_a_gear_that_swings_behind_the_air_from_before_the_record_on(
    constants_s: tuple[float, ...], tmp_path: Path
) -> None:
    """It is up to 15 K off the air at the first row. Soaked, its gap moves by 0.6 arcsec/K."""
    found = swinging(masses(*constants_s), tmp_path)
    assert abs(found.magnitude - PER_KELVIN) < 2 * found.magnitude_std
    assert found.magnitude == pytest.approx(PER_KELVIN, rel=0.05)


def test_two_stages_behind_a_steady_rise() -> None:
    """r·(t − 2τ + (t + 2τ)·e^(−t/τ)): two equal first-order lags of a ramp r·t, from rest."""
    history = replace(sweep(), temperature_C=20.0 + 0.01 * (sweep().time_s - sweep().time_s[0]))
    tau, t = 300.0, sweep().time_s - sweep().time_s[0]
    shape = {"lag_s": tau, "longest_lag_s": 1e3, "stages": 2.0}
    rise = 0.01 * (t - 2 * tau + (t + 2 * tau) * np.exp(-t / tau))
    # the second stage takes the first as straight over 5 s: off by 5²/8 of its curvature, 0.01/300 K/s²
    np.testing.assert_allclose(
        CAUSE.columns(shape, history)[:, 0], rise * history.sign / 2, atol=25 / 8 * 0.01 / 300
    )


@pytest.mark.parametrize(("way", "side"), [("warmer_K", 1.0), ("colder_K", -1.0)])
@pytest.mark.parametrize("stages", [1, 2])
def test_a_gear_off_at_the_start_comes_back(way: str, side: float, stages: int) -> None:
    """In still air by e^(−t/τ), behind a housing that was off as far by (1 + t/τ)·e^(−t/τ)."""
    history = replace(sweep(), temperature_C=np.full(len(sweep()), 20.0))
    t = (history.time_s - history.time_s[0]) / 300.0
    shape = {"lag_s": 300.0, "longest_lag_s": 1e3, way: 4.0, "most_off_K": 6.0}
    shape |= {"stages": 2.0} if stages == 2 else {}
    left = 4.0 * side * np.exp(-t) * (1 + t if stages == 2 else 1.0)
    np.testing.assert_allclose(
        CAUSE.columns(shape, history)[:, 0], left * history.sign / 2, atol=1e-9
    )


def test_gap_and_temperature_alone_are_no_curve() -> None:
    """A gap linear in temperature leaves nothing in the term for one that is not."""
    rig = FitContext(PREDICTION, sweep())
    curved = next(c for _, what, c in over_temperature(rig) if what == UnnamedForm("bent_gap"))[
        :, 0
    ]
    side, warmth = sweep().sign, sweep().temperature_C - 20.0
    assert abs(curved @ side) < 1e-9 * len(side)
    assert abs(curved @ (warmth * side)) < 1e-6 * len(side)
    assert abs(curved @ (warmth**2 * side)) > 1.0
