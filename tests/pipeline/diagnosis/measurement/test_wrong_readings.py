"""Readings that no gear made: they are left out and told, and what a gear or a programme does stays."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.measurement.record import Sweep, read_measurement
from flexspline.results.diagnosis.notes import notes
from flexspline.results.diagnosis.record import diagnosis_record

Columns = dict[str, np.ndarray]
COMPLIANCE, GAP = 11.343, 72.2
"""arcsec per N·m and arcsec, of the example with the stiffnesses below."""
GIVEN = (31329.0, 43339.0)
ROWS, PER_CYCLE = 600, 120


def record(seed: int = 5) -> Columns:
    """Five cycles of the simulated gear with a loop of 12 arcsec, ± 10 N·m, 21 °C."""
    i = np.arange(ROWS)
    rng = np.random.default_rng(seed)
    torque = 10 * (1 - 4 * np.abs(((i + 0.5) / PER_CYCLE + 0.25) % 1 - 0.5))
    loop = 6.0 * np.sign(np.gradient(torque)) * (1 - (torque / 10) ** 2)
    angle = COMPLIANCE * torque + GAP / 2 * np.sign(torque) - loop + rng.normal(0, 0.4, ROWS)
    return {
        "time_s": 3.0 * i,
        "temperature_C": (21 + rng.normal(0, 0.03, ROWS)).round(2),
        "torque_Nm": torque.round(4),
        "angle_arcsec": angle.round(3),
    }


def written(columns: Columns, folder: Path, heads: dict[str, str] | None = None) -> Path:
    path = folder / "rig.csv"
    head = ",".join((heads or {}).get(name, name) for name in columns)
    body = "\n".join(
        ",".join(f"{v:.12g}" for v in row) for row in zip(*columns.values(), strict=True)
    )
    path.write_text(f"{head}\n{body}\n", encoding="utf-8")
    return path


def read(columns: Columns, folder: Path) -> Sweep:
    sweep = read_measurement(written(columns, folder))
    assert isinstance(sweep, Sweep)
    return sweep


ONE, FEW, RUN = [137], [50, 51, 200, 333, 400], list(range(300, 330))


@pytest.mark.parametrize(
    ("names", "rows", "value"),
    [
        (("torque_Nm",), ONE, 1e6),
        (("torque_Nm",), FEW, 9999.0),
        (("torque_Nm",), RUN, 999.0),
        (("torque_Nm",), FEW, -850.0),
        (("angle_arcsec",), ONE, 1e12),
        (("angle_arcsec",), RUN, 9999.0),
        (("torque_Nm", "angle_arcsec"), FEW, 9999.0),
    ],
)
def test_rows_of_a_wrong_torque_or_angle_are_left_out(
    names: tuple[str, ...], rows: list[int], value: float, tmp_path: Path
) -> None:
    columns = record()
    for name in names:
        columns[name][rows] = value
    sweep = read(columns, tmp_path)
    (wrong,) = sweep.wrong
    assert wrong.lines == tuple(r + 2 for r in rows)  # the head is line 1
    assert set(wrong.values) == {value}
    kept = np.delete(np.arange(ROWS), rows)
    np.testing.assert_array_equal(sweep.history.torque_Nm, record()["torque_Nm"][kept])
    np.testing.assert_array_equal(sweep.angle_arcsec, record()["angle_arcsec"][kept])
    assert sweep.history.cycle_count == 5


def test_wrong_readings_of_different_sizes_are_all_found(tmp_path: Path) -> None:
    columns = record()
    columns["torque_Nm"][[40, 90]] = 1e6, -777.0
    columns["angle_arcsec"][[350, 460]] = 1e12, 1e5
    sweep = read(columns, tmp_path)
    assert {w.name: w.lines for w in sweep.wrong} == {
        "angle_arcsec": (352, 462), "torque_Nm": (42, 92),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("rows", "value"), [(FEW, 850.0), (RUN, 999.0), (FEW, -200.0), (ONE, 85.0)]
)
def test_a_wrong_temperature_is_bridged(rows: list[int], value: float, tmp_path: Path) -> None:
    columns = record()
    columns["temperature_C"][rows] = value
    sweep = read(columns, tmp_path)
    assert len(sweep) == ROWS
    assert [w.lines for w in sweep.wrong] == [tuple(r + 2 for r in rows)]
    np.testing.assert_allclose(sweep.history.temperature_C, 21.0, atol=0.2)


def few_large_cycles(columns: Columns) -> None:
    """Nine of ten rows within ± 1 N·m, then one way to 10 N·m in two rows."""
    columns["angle_arcsec"] -= 0.9 * COMPLIANCE * columns["torque_Nm"]
    columns["torque_Nm"] /= 10
    columns["torque_Nm"][500:502] = 10.0
    columns["angle_arcsec"][500:502] = COMPLIANCE * 10 + GAP / 2


def slipped_teeth(columns: Columns) -> None:
    columns["angle_arcsec"][400:] += 36_000.0


def hot_cycle(columns: Columns) -> None:
    """A chamber at 90 °C in the last cycle, read to whole degrees."""
    columns["temperature_C"] = np.where(np.arange(ROWS) < 480, 21.0, 90.0)


def other_zeros(columns: Columns) -> None:
    """Units on an absolute encoder."""
    columns["unit"] = np.where(np.arange(ROWS) < 480, 1.0, 2.0)
    columns["angle_arcsec"][480:] += 400_000.0


def staircase(columns: Columns) -> None:
    """Rests at zero with little noise, and single readings under load between them."""
    columns["torque_Nm"] = np.where(np.arange(ROWS) % 3 == 1, columns["torque_Nm"], 0.0)
    columns["angle_arcsec"] = np.where(np.arange(ROWS) % 3 == 1, columns["angle_arcsec"], 0.1)


def short_pulses(columns: Columns) -> None:
    """Of torque that the gear feels: one row each, 4 N·m, and the angle goes with it."""
    columns["torque_Nm"][FEW] += 4.0
    columns["angle_arcsec"][FEW] += 4.0 * COMPLIANCE


def stuck_turns(columns: Columns) -> None:
    """Twelve rows a cycle, and a bearing that sticks at each turn: the angle stays while torque turns."""
    i = np.arange(ROWS)
    torque = 10 * (1 - 4 * np.abs(((i + 0.5) / 12 + 0.25) % 1 - 0.5))
    stuck = play(torque, 4.0)
    columns["torque_Nm"] = torque
    columns["angle_arcsec"] = COMPLIANCE * stuck + GAP / 2 * np.sign(stuck)


def play(torque: np.ndarray, width: float) -> np.ndarray:
    out = np.zeros(len(torque))
    for i in range(1, len(torque)):
        out[i] = np.clip(out[i - 1], torque[i] - width, torque[i] + width)
    return out


def noisy_angle(columns: Columns) -> None:
    """Spikes of the size that noise tests look at later."""
    columns["angle_arcsec"][FEW] += 150.0


@pytest.mark.parametrize(
    "change",
    [
        few_large_cycles,
        slipped_teeth,
        hot_cycle,
        other_zeros,
        staircase,
        noisy_angle,
        short_pulses,
        stuck_turns,
    ],
)
def test_what_a_gear_or_a_programme_does_stays(change, tmp_path: Path) -> None:
    columns = record()
    change(columns)
    sweep = read(columns, tmp_path)
    assert sweep.wrong == ()
    assert len(sweep) == ROWS


def switched(seed: int) -> tuple[Columns, np.ndarray]:
    """A motor's switching in the cable of the load cell: single rows of 1 to 8 N·m, of a record to 10 N·m;
    and which rows."""
    columns, rng = record(seed), np.random.default_rng(seed)
    rows = np.sort(rng.choice(np.arange(5, ROWS - 5, 3), 12, replace=False))
    columns["torque_Nm"][rows] += rng.choice([-1, 1], 12) * rng.uniform(1.5, 8, 12)
    return columns, rows


@pytest.mark.parametrize("seed", range(3))
def test_torques_that_the_angle_does_not_follow_are_wrong(tmp_path: Path, seed: int) -> None:
    columns, rows = switched(seed)
    (wrong,) = read(columns, tmp_path).wrong
    assert wrong.lines == tuple(rows + 2)


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in (1, 2))]
)
def test_torques_that_the_angle_does_not_follow_change_no_cause(tmp_path: Path, seed: int) -> None:
    columns, _ = switched(seed)
    found = diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), written(columns, tmp_path), *GIVEN)
    assert [c.id for c in found.causes] == ["friction_hysteresis"]


def test_the_verdict_is_that_of_the_record_without_them(tmp_path: Path) -> None:
    design = load_design(EXAMPLES / "xb1-40.toml")
    columns = record()
    right = diagnose_file(design, written(columns, tmp_path), *GIVEN)
    assert [c.id for c in right.causes] == ["friction_hysteresis"]
    columns["torque_Nm"][137] = 1e6
    columns["angle_arcsec"][260] = 1e12
    found = diagnose_file(design, written(columns, tmp_path), *GIVEN)
    assert [c.id for c in found.causes] == ["friction_hysteresis"]
    assert found.causes[0].magnitude == pytest.approx(right.causes[0].magnitude, rel=0.02)
    rows = diagnosis_record(found)["rows"]
    assert rows["read"] == ROWS
    assert rows["used"] + sum(rows["left_out"].values()) == ROWS
    assert rows["left_out"]["outlier"] >= 2
    told = notes(found)
    assert any("angle_arcsec = 1e+12 arcsec in line 262" in n for n in told)
    assert any(
        "torque_Nm = 1000000 Nm in line 139" in n and "the row is left out" in n for n in told
    )


def test_without_time_rows_are_counted_as_the_file_has_them(tmp_path: Path) -> None:
    """As `predict` counts them: rows that are left out of the fit go on counting."""
    columns = record()
    del columns["time_s"]
    columns["torque_Nm"][RUN] = 999.0
    sweep = read(columns, tmp_path)
    assert len(sweep) == ROWS - len(RUN)
    number = sweep.history.timed().time_s
    assert number is not None
    left = np.delete(np.arange(ROWS), RUN)
    assert number.tolist() == left.tolist()
    assert sweep.file_rows(number >= 299).tolist() == left[left >= 299].tolist()


def test_the_file_s_own_words_and_unit_are_told(tmp_path: Path) -> None:
    columns = record()
    columns["torque_Nm"] = columns["torque_Nm"] * 1000
    columns["torque_Nm"][FEW] = 999_999.0
    path = written(columns, tmp_path, {"torque_Nm": "Moment [Nmm]"})
    found = diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, *GIVEN)
    (note,) = (n for n in notes(found) if "fault" in n)
    assert "Moment [Nmm] = 999999 Nmm in lines 52, 53, 202, 335, 402" in note
    assert "the rows are left out" in note
