"""Channels that stand still: a clock in all rows, torque and angle in a run of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.record import Sweep, read_measurement
from flexspline.results.diagnosis.notes import record_notes

ROWS = 60


def sweep(tmp_path: Path, time_step_s: float = 1.0, dropped: int = 0) -> Sweep:
    rng = np.random.default_rng(3)
    lines = ["time_s,torque_Nm,angle_arcsec"]
    for i in range(ROWS):
        torque, angle = 3 * np.sin(i / 5), 40 * np.sin(i / 5) + rng.normal()
        if 30 <= i < 30 + dropped:
            torque = angle = 0.0
        lines.append(f"{5 + i * time_step_s},{torque:.4f},{angle:.4f}")
    path = tmp_path / "rig.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    read = read_measurement(path)
    assert isinstance(read, Sweep)
    return read


def test_a_clock_that_stands_still_was_not_recorded(tmp_path: Path) -> None:
    frozen = sweep(tmp_path, time_step_s=0.0)
    assert frozen.history.time_s is None
    assert record_notes(frozen) == ["time is the same in all rows: taken as not recorded"]


def test_a_record_whose_channels_move_has_no_note(tmp_path: Path) -> None:
    running = sweep(tmp_path)
    assert running.history.time_s is not None
    assert record_notes(running) == []


@pytest.mark.parametrize(("dropped", "told"), [(19, False), (25, True)])
def test_the_lines_of_a_long_dropout_are_named(dropped: int, told: bool, tmp_path: Path) -> None:
    found = record_notes(sweep(tmp_path, dropped=dropped))
    assert len(found) == told
    assert all("from line 32 to line 56" in note for note in found)


def test_holds_of_a_record_without_noise_are_no_dropout(tmp_path: Path) -> None:
    held = [f"{30 * i + k},{t},{10 * t}" for i, t in enumerate((1, 2, 1, -1)) for k in range(30)]
    path = tmp_path / "rig.csv"
    path.write_text("\n".join(["time_s,torque_Nm,angle_arcsec", *held]), encoding="utf-8")
    read = read_measurement(path)
    assert isinstance(read, Sweep)
    assert record_notes(read) == []
