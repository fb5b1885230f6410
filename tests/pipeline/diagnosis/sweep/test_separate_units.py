"""Records of several units, of which one shows an effect and the others do not: its size is that unit's."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from histories import sweep as swept

import flexspline
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome
from flexspline.pipeline.diagnosis.structure import LateAngle
from flexspline.pipeline.diagnosis.sweep.separate_units import of_units
from flexspline.results.diagnosis.structure_words import structure_words

pytestmark = pytest.mark.usefixtures("causes_only")

DESIGN = flexspline.load_design(EXAMPLES / "xb1-40.toml")
WITH = "b"
STEP_S, CYCLE = 20.0, 75
"""Between rows, and rows of a cycle."""
HEAD = "unit,time_s,cycle,torque_Nm,temperature_C,angle_arcsec"


def friction(torque: np.ndarray, threshold: float) -> np.ndarray:
    """State of one elastic-plastic element, in N·m."""
    state = np.zeros(len(torque))
    for i in range(1, len(torque)):
        state[i] = np.clip(state[i - 1] + torque[i] - torque[i - 1], -threshold, threshold)
    return state


def outcome_of(
    folder: Path, angles: Mapping[str, np.ndarray], torque: np.ndarray, warm: np.ndarray
) -> DiagnosisOutcome:
    """Of a file in which every unit, by its name, has the same torques and temperatures."""
    lines = [HEAD]
    for unit, angle in angles.items():
        lines += [
            f"{unit},{STEP_S * i},{i // CYCLE + 1},{torque[i]:.4f},{warm[i]:.2f},{angle[i]:.3f}"
            for i in range(len(torque))
        ]
    path = folder / "m.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return diagnose_file(DESIGN, path, 31312, 43275).outcome


TIME_S = STEP_S * np.arange(6 * CYCLE)
TORQUE = 2.0 * np.interp(np.arange(6 * CYCLE) % CYCLE, [0, 20, 55, CYCLE - 1], [0, 1, -1, 0])
WARM = 20.0 + 8.0 * np.sin(TIME_S / 1400)


def angle_of(effect: str | None, rng: np.random.Generator) -> np.ndarray:
    """A gear of 11.35 arcsec per N·m and a gap of 72 arcsec, with one effect or none."""
    gap = 72.0 - 0.6 * (WARM - 20) * (effect == "thermal_clearance")
    angle = 11.35 * TORQUE + gap / 2 * np.sign(TORQUE) + rng.normal(0, 0.3, len(TORQUE))
    if effect == "friction_hysteresis":
        angle -= 5.0 / 0.8 * friction(TORQUE, 0.8)
    if effect == "series_compliance":
        angle += 0.2 * 11.35 * TORQUE
    if effect == "sensor_drift":
        angle += 12.0 * TIME_S / 3600
    return angle


TRUE = {
    "friction_hysteresis": 10.0,  # arcsec, full width of the loop at T = 0
    "thermal_clearance": -0.6,  # arcsec per K
    "sensor_drift": 12.0,  # arcsec per hour
}


@pytest.mark.parametrize("effect", TRUE)
def test_the_size_is_that_of_the_unit_that_shows_it(effect: str, tmp_path: Path) -> None:
    """A mean over the units is a third of it, and what that misses has no name."""
    rng = np.random.default_rng(4)
    angles = {unit: angle_of(effect if unit == WITH else None, rng) for unit in "abc"}
    outcome = outcome_of(tmp_path, angles, TORQUE, WARM)
    assert outcome.verdict == "named"
    (cause,) = outcome.causes
    assert cause.id == effect
    assert cause.own_units == (WITH,)
    assert abs(cause.magnitude - TRUE[effect]) < 3 * cause.magnitude_std
    assert cause.magnitude_std < abs(TRUE[effect]) / 20


def test_units_that_show_different_things_have_each_its_own(tmp_path: Path) -> None:
    rng = np.random.default_rng(6)
    shows = {"a": "sensor_drift", "b": None, "c": "friction_hysteresis"}
    angles = {unit: angle_of(effect, rng) for unit, effect in shows.items()}
    outcome = outcome_of(tmp_path, angles, TORQUE, WARM)
    own = {c.id: c.own_units for c in outcome.causes}
    assert own == {"sensor_drift": ("a",), "friction_hysteresis": ("c",)}


def test_what_all_units_show_is_told_by_all(tmp_path: Path) -> None:
    rng = np.random.default_rng(7)
    angles = {unit: angle_of("thermal_clearance", rng) for unit in "abc"}
    (cause,) = outcome_of(tmp_path, angles, TORQUE, WARM).causes
    assert cause.id == "thermal_clearance"
    assert cause.own_units == ()


def test_a_unit_is_called_by_the_name_that_the_file_gives_it(tmp_path: Path) -> None:
    """A gear that is a fifth softer than the others has no cause's name: its reading may have a gain."""
    rng = np.random.default_rng(5)
    effects = {"left": None, "right": None, "spare": "series_compliance"}
    angles = {unit: angle_of(effect, rng) for unit, effect in effects.items()}
    outcome = outcome_of(tmp_path, angles, TORQUE, WARM)
    assert outcome.verdict == "unknown"
    (left,) = outcome.unexplained
    assert left.channel == "unit"
    assert "of unit spare" in structure_words(left)


def test_the_rows_of_some_units_are_a_record_of_their_own() -> None:
    history = swept(cycles=2, units=4)
    rows = np.arange(len(history))
    record = Sweep(
        Path("m.csv"), history, rows.astype(float), ("a", "b", "c", "d"),
        ((1.0, 2.0), (3.0, 4.0), (5.0, 6.0), (7.0, 8.0)), rows + 2, True,
    )  # fmt: skip
    some = of_units(record, (3, 1))
    assert some.units == ("b", "d")
    assert some.cycles == ((3.0, 4.0), (7.0, 8.0))
    taken = np.isin(history.unit, (1, 3))
    assert np.array_equal(some.angle_arcsec, rows[taken])
    assert np.array_equal(some.line, rows[taken] + 2)
    assert np.array_equal(some.own_cycle, record.own_cycle[taken])


def test_a_unit_of_another_size_stands_apart(tmp_path: Path) -> None:
    """All three rub, one of them three times as much: no mean of the three is any gear's."""
    rng = np.random.default_rng(8)
    angles = {
        unit: angle_of(None, rng) - half_arcsec / 0.8 * friction(TORQUE, 0.8)
        for unit, half_arcsec in (("a", 3.0), ("b", 9.0), ("c", 3.2))
    }
    outcome = outcome_of(tmp_path, angles, TORQUE, WARM)
    assert outcome.verdict == "named"
    assert not outcome.unexplained  # what units miss of their mean is no stick-slip
    sizes = {c.own_units: (c.magnitude, c.magnitude_std) for c in outcome.causes}
    assert set(sizes) == {("b",), ("a", "c")}
    assert abs(sizes["b",][0] - 18.0) < 3 * sizes["b",][1]
    assert abs(sizes["a", "c"][0] - 6.2) < 3 * sizes["a", "c"][1]


def test_a_gap_far_from_the_simulated_one_is_that_unit_s(tmp_path: Path) -> None:
    rng = np.random.default_rng(9)
    angles = {unit: angle_of(None, rng) + (unit == WITH) * 40 * np.sign(TORQUE) for unit in "abc"}
    outcome = outcome_of(tmp_path, angles, TORQUE, WARM)
    (cause,) = outcome.causes
    assert (cause.id, cause.own_units) == ("clearance_offset", (WITH,))
    assert abs(cause.magnitude - 80.0) < 3 * cause.magnitude_std


def test_one_unit_that_is_read_late_is_the_answer(tmp_path: Path) -> None:
    """Its angle channel has a filter of 40 s, two rows: all rows made a soft wind-up and friction of it."""
    rng = np.random.default_rng(10)
    angles = {unit: angle_of(None, rng) for unit in "abc"}
    late = angles["c"].copy()
    for i in range(1, len(late)):
        late[i] = late[i - 1] + (angles["c"][i] - late[i - 1]) * -np.expm1(-STEP_S / 40)
    outcome = outcome_of(tmp_path, {**angles, "c": late}, TORQUE, WARM)
    assert outcome.verdict == "unknown"
    assert not outcome.causes
    assert isinstance(outcome.unexplained[0].structure, LateAngle)
