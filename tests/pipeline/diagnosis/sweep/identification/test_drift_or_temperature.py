"""A zero that follows a temperature which rises all the time is no drift with time that is sure."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.results.diagnosis.advice import why
from flexspline.results.diagnosis.notes import notes
from flexspline.results.diagnosis.words import cause_title, sure_words

pytestmark = pytest.mark.usefixtures("causes_only")

ROWS, PER_CYCLE = 720, 120
PER_KELVIN, PER_RECORD = 1.5, 18.0
"""arcsec/K, and arcsec in the whole record: alike where it warms up by 12 K."""
Course = Callable[[np.ndarray], np.ndarray]


def rises(share: np.ndarray) -> np.ndarray:
    return 12 * share


def swings(share: np.ndarray) -> np.ndarray:
    return 6 * np.sin(5 * share)


def of_time(share: np.ndarray) -> np.ndarray:
    return PER_RECORD * share


def diagnosed(warmth: Course, zero: Course, folder: Path) -> Diagnosis:
    """The simulated gear; `warmth` [K] over 21 °C and `zero` [arcsec], both of the share of the record."""
    i = np.arange(ROWS)
    rng = np.random.default_rng(0)
    torque = 10 * (1 - 4 * np.abs(((i + 0.5) / PER_CYCLE + 0.25) % 1 - 0.5))
    share = i / ROWS
    angle = 11.343 * torque + 36.1 * np.sign(torque) + zero(share) + rng.normal(0, 0.5, ROWS)
    celsius = 21 + warmth(share) + rng.normal(0, 0.03, ROWS)
    path = folder / "rig.csv"
    body = "".join(
        f"{3 * k},{c:.2f},{t:.4f},{a:.2f}\n"
        for k, c, t, a in zip(i, celsius, torque, angle, strict=True)
    )
    path.write_text("time_s,temperature_C,torque_Nm,angle_arcsec\n" + body)
    return diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, 31329.0, 43339.0)


def late(share: np.ndarray) -> np.ndarray:
    """1.5 arcsec/K of a gear that warms a tenth of the record behind the sensor: u − τ(1 − e^(−u/τ)) of a
    warmth that rises with u."""
    return PER_KELVIN * 12 * (share - 0.1 * (1 - np.exp(-share / 0.1)))


@pytest.mark.parametrize(
    "zero",
    [lambda share: PER_KELVIN * rises(share), pytest.param(of_time, marks=pytest.mark.long), late],
)
def test_time_and_a_steady_rise_are_not_told_apart(zero: Course, tmp_path: Path) -> None:
    found = diagnosed(rises, zero, tmp_path)
    (cause,) = found.causes
    assert cause.id == "sensor_drift"
    assert cause.or_temperature
    assert cause_title(cause) == "drift of the angle reading (with time or temperature)"
    assert sure_words(cause).endswith("time or temperature undecided")
    assert any("follows the temperature fits it as well" in n for n in notes(found))
    after = found.outcome.next_measurement
    assert after is not None
    assert after.vary == "temperature_C"
    assert "in another order" in why(after, "sweep")


def test_a_temperature_that_swings_tells_them_apart(tmp_path: Path) -> None:
    (cause,) = diagnosed(swings, of_time, tmp_path).causes
    assert cause.id == "sensor_drift"
    assert not cause.or_temperature
    assert cause_title(cause) == "drift of the angle reading"
    follows = diagnosed(swings, lambda share: PER_KELVIN * swings(share), tmp_path)
    assert follows.verdict == "unknown"


def test_a_drift_beside_turns_of_the_wave_generator_has_no_temperature(tmp_path: Path) -> None:
    """A zero that changes with those turns is a term of its own; the record has no temperature."""
    found = diagnosed(rises, of_time, tmp_path)
    lines = (tmp_path / "rig.csv").read_text().splitlines()[1:]
    turned = tmp_path / "turned.csv"
    rows = [line.split(",") for line in lines]
    turned.write_text(
        "time_s,input_angle_deg,torque_Nm,angle_arcsec\n"
        + "".join(f"{t},{15 * (k // 30)},{q},{a}\n" for k, (t, _, q, a) in enumerate(rows))
    )
    (cause,) = diagnose_file(found.design, turned, 31329.0, 43339.0).causes
    assert cause.id == "sensor_drift"
    assert not cause.or_temperature
