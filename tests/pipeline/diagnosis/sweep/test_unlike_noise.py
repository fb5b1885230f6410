"""Cycles and units whose torque was read with unlike noise: another load cell, a motor that ran beside."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from test_noisy_torque import ANGLE_NOISE, COMPLIANCE, GAP, K_B, K_E, LARGEST

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.torque_noise import (
    torque_noise_Nm,
    torque_noise_of_rows_Nm,
)

NOISES_Nm = (0.02, 0.5, 0.1, 0.3)
CYCLE_ROWS, LOOP, THRESHOLD_Nm = 750, 12.0, 5.0


def turned(count: int, unit_of: np.ndarray) -> History:
    """Triangles, each cycle with its own noise."""
    rows = np.arange(count * CYCLE_ROWS)
    cycle = rows // CYCLE_ROWS
    side = 2 * np.pi * rows / CYCLE_ROWS
    true = LARGEST * 2 / np.pi * np.arcsin(np.sin(side))
    noise = np.array(NOISES_Nm)[cycle] * np.random.default_rng(count).normal(size=len(rows))
    own = np.concatenate([np.arange(np.sum(unit_of == u)) for u in np.unique(unit_of)])
    return History(true + noise, unit_of[cycle], own[cycle], 0.1 * rows)


@pytest.mark.parametrize("unit_of", [np.zeros(4, int), np.arange(4)])
def test_each_cycle_has_its_own_noise(unit_of: np.ndarray) -> None:
    history = turned(4, unit_of)
    found = torque_noise_of_rows_Nm(history).reshape(4, CYCLE_ROWS)
    assert (np.ptp(found, axis=1) == 0).all()
    # a median of 750 numbers of which neighbours share readings: to 1.17·√(3/750) = 7 %
    assert found[:, 0] == pytest.approx(np.array(NOISES_Nm), rel=3 * 0.07)
    assert torque_noise_Nm(history) == found.max()


def test_cycles_that_differ_by_chance_have_one() -> None:
    rows = np.arange(40 * 24)
    torque = LARGEST * np.sin(2 * np.pi * rows / 24) + 0.3 * np.random.default_rng(4).normal(
        size=len(rows)
    )
    history = History(torque, np.zeros(len(rows), int), rows // 24, 0.1 * rows)
    assert np.ptp(torque_noise_of_rows_Nm(history)) == 0


def diagnosed(folder: Path, unit_of: np.ndarray, loop_arcsec: float) -> Diagnosis:
    history, rng = turned(4, unit_of), np.random.default_rng(9)
    rows = np.arange(len(history))
    true = LARGEST * 2 / np.pi * np.arcsin(np.sin(2 * np.pi * rows / CYCLE_ROWS))
    slid = np.zeros(len(rows))
    for i in range(1, len(rows)):
        fresh = history.unit[i] != history.unit[i - 1]
        step = 0.0 if fresh else true[i] - true[i - 1]
        slid[i] = np.clip((0.0 if fresh else slid[i - 1]) + step, -THRESHOLD_Nm, THRESHOLD_Nm)
    angle = COMPLIANCE * true + GAP / 2 * np.sign(true) - loop_arcsec / 2 * slid / THRESHOLD_Nm
    angle += ANGLE_NOISE * rng.normal(size=len(rows))
    columns = [history.time_s, history.torque_Nm, angle, history.cycle, history.unit]
    csv = folder / "measured.csv"
    np.savetxt(
        csv, np.column_stack(columns), delimiter=",", comments="", fmt="%.6g",
        header="time_s,torque_Nm,angle_arcsec,cycle,unit",
    )  # fmt: skip
    return diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), csv, K_B, K_E)


@pytest.mark.parametrize(
    "unit_of", [pytest.param(np.zeros(4, int), marks=pytest.mark.long), np.arange(4) // 2]
)
def test_a_gear_without_effects_is_told_so(tmp_path: Path, unit_of: np.ndarray) -> None:
    assert diagnosed(tmp_path, unit_of, 0.0).verdict == "consistent"


@pytest.mark.parametrize(
    "unit_of", [pytest.param(np.zeros(4, int), marks=pytest.mark.long), np.arange(4) // 2]
)
def test_friction_is_found_beside_it(tmp_path: Path, unit_of: np.ndarray) -> None:
    found = diagnosed(tmp_path, unit_of, LOOP)
    assert found.verdict == "named"
    assert [c.id for c in found.causes] == ["friction_hysteresis"]
    assert found.causes[0].magnitude == pytest.approx(LOOP, abs=3 * found.causes[0].magnitude_std)
