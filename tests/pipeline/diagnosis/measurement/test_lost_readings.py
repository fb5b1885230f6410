"""Rows that lost a reading: few are left out and counted, many or many in a row are refused."""

from __future__ import annotations

import csv
import random
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
from example_files import EXAMPLES

import flexspline
from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import Sweep, read_measurement
from flexspline.results.diagnosis.reading import lost_note

ROWS = 400
HEAD = ["time_s", "torque_Nm", "angle_arcsec"]


CELLS = [
    "", " ", "NaN", "-", "---", "#N/A", "#VALUE!", "#WERT!", "null", "err", "Inf", "-inf", "ovld", "OVERLOAD",
    "-OL", "1.#QNAN", "9.91E37", "nan(ind)",
]  # fmt: skip
"""As loggers, spreadsheets and SCPI instruments write that there is no reading."""


def reading(i: int) -> list[str]:
    torque = 5 * np.sin(2 * np.pi * i / 100)
    return [f"{0.5 * i:.1f}", f"{torque:.4f}", f"{20 * torque:.3f}"]


def swept(
    tmp_path: Path, lost: Iterable[int], cell: str = "", column: int = 1, timed: bool = True
) -> Sweep:
    rows = [reading(i) for i in range(ROWS)]
    for i in lost:
        rows[i][column] = cell
    first = 0 if timed else 1
    return read_rows(tmp_path, [r[first:] for r in rows], HEAD[first:])


def read_rows(tmp_path: Path, rows: list[list[str]], head: list[str] = HEAD) -> Sweep:
    path = tmp_path / "rig.csv"
    path.write_text("".join(",".join(r) + "\n" for r in (head, *rows)), encoding="utf-8")
    found = read_measurement(path)
    assert isinstance(found, Sweep)
    return found


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("column", [1, 2])
def test_few_are_left_out_and_counted(cell: str, column: int, tmp_path: Path) -> None:
    lost = [0, 37, 200, 201, 399]
    found = swept(tmp_path, lost, cell, column)
    kept = [i for i in range(ROWS) if i not in lost]
    assert found.history.time_s is not None
    assert found.history.time_s == pytest.approx(0.5 * np.array(kept))  # the file's own times
    assert list(found.line) == [i + 2 for i in kept]
    assert found.lost is not None
    assert found.lost.lines == tuple(i + 2 for i in lost)
    assert list(found.file_rows(np.ones(len(found), bool))) == kept
    note = lost_note(found.lost)
    assert note.startswith(
        f"{HEAD[column]} has no reading in 5 of 400 rows (lines 2, 39, 202, 203, 401)"
    )


def test_without_a_clock_the_rows_keep_the_file_s_numbers(tmp_path: Path) -> None:
    lost = [10, 11, 300]
    history = swept(tmp_path, lost, timed=False).history
    assert history.time_s is None
    numbers = history.time_or_rows(np.arange(len(history)))
    assert list(numbers) == [i for i in range(ROWS) if i not in lost]


def test_a_twentieth_is_the_most(tmp_path: Path) -> None:
    assert len(swept(tmp_path, range(0, ROWS, 20))) == 380
    with pytest.raises(MeasurementError, match=r"21 of 400 rows.* up to 5 % of the rows"):
        swept(tmp_path, [*range(0, ROWS, 20), 7])


def test_a_long_hole_may_hide_a_reversal(tmp_path: Path) -> None:
    """A hundredth of 400 rows are four."""
    assert len(swept(tmp_path, range(23, 27))) == 396
    with pytest.raises(
        MeasurementError, match="no reading in 5 rows one after another; at most 4"
    ) as no:
        swept(tmp_path, range(23, 28))
    assert no.value.line == 25


def test_end_points_and_short_files_are_refused_as_before(tmp_path: Path) -> None:
    path = tmp_path / "ends.csv"
    head = "unit,torque_Nm,angle_plus_arcsec,angle_minus_arcsec\n"
    path.write_text(head + "1,0.5,30,-30\n" * 40 + "1,,30,-30\n", encoding="utf-8")
    with pytest.raises(MeasurementError, match="torque_Nm is empty"):
        read_measurement(path)
    path.write_text("torque_Nm,angle_arcsec\n" + "1,2\n" * 18 + ",2\n", encoding="utf-8")
    with pytest.raises(MeasurementError, match="1 of 19 rows lack a reading"):
        read_measurement(path)


def test_rows_are_counted_and_not_the_cells_of_one_column(tmp_path: Path) -> None:
    """Each column by itself lost fewer than a twentieth of 400 rows."""
    rows = [reading(i) for i in range(ROWS)]
    for i in range(0, 120, 8):
        rows[i][1] = ""
    for i in range(144, 300, 12):
        rows[i][2] = "---"
    with pytest.raises(MeasurementError) as no:
        read_rows(tmp_path, rows)
    assert no.value.line == 2
    said = no.value.reason
    assert said.startswith("28 of 400 rows lack a reading (torque_Nm in 15 and angle_arcsec in 13)")


@pytest.mark.parametrize("cell", ["", "#N/A", "---"])
@pytest.mark.parametrize("name", ["time_s", "temperature_C", "cycle", "input_angle_deg"])
def test_a_lost_reading_of_another_channel_leaves_its_row_out(
    name: str, cell: str, tmp_path: Path
) -> None:
    head = [*HEAD, "temperature_C", "cycle", "input_angle_deg"]
    rows = [[*reading(i), "21.5", str(1 + i // 100), "0"] for i in range(ROWS)]
    rows[57][head.index(name)] = cell
    found = read_rows(tmp_path, rows, head)
    assert list(found.line) == [i + 2 for i in range(ROWS) if i != 57]
    assert found.lost is not None
    assert lost_note(found.lost).startswith(f"{name} has no reading in 1 of 400 rows (line 59)")
    for row in rows[:60]:
        row[head.index(name)] = cell
    with pytest.raises(MeasurementError, match=rf"60 of 400 rows .*, or take {name} out"):
        read_rows(tmp_path, rows, head)


def test_a_row_that_begins_with_a_spreadsheet_s_error_is_no_comment(tmp_path: Path) -> None:
    rows = [reading(i) for i in range(ROWS)]
    rows[57][0] = "#N/A"
    rows[58] = ["# the pump was switched on", "", ""]
    found = read_rows(tmp_path, rows)
    assert found.lost is not None
    assert found.lost.lines == (59,)
    assert len(found) == ROWS - 2


def test_a_column_that_says_in_every_row_that_nothing_was_recorded_is_none(tmp_path: Path) -> None:
    found = read_rows(
        tmp_path, [[*reading(i), "n/a"] for i in range(ROWS)], [*HEAD, "temperature_C"]
    )
    assert found.history.temperature_C is None
    assert found.lost is None
    assert len(found) == ROWS


def test_lost_rows_change_no_verdict_and_no_size_beyond_its_doubt(tmp_path: Path) -> None:
    """Friction and what it remembers, with a row in 25 lost at random: two standard deviations at most."""
    whole = EXAMPLES / "measured" / "xb1-40-sweep.csv"
    with whole.open(encoding="utf-8") as file:
        head, *rows = [r for r in csv.reader(file) if r and not r[0].startswith("#")]
    torque = head.index("torque_Nm")
    for i in random.Random(7).sample(range(len(rows)), len(rows) // 25):
        rows[i][torque] = ""
    holed = tmp_path / "holed.csv"
    holed.write_text("".join(",".join(r) + "\n" for r in (head, *rows)), encoding="utf-8")
    design = load_design(EXAMPLES / "xb1-40.toml")
    first, second = (
        flexspline.diagnose(design, path, K_b=31_000.0, K_e=19_000.0) for path in (whole, holed)
    )
    assert second.verdict == first.verdict
    sizes = {c.id: c for c in second.causes}
    assert sizes.keys() == {c.id for c in first.causes}
    for cause in first.causes:
        other = sizes[cause.id]
        doubt = np.hypot(cause.magnitude_std, other.magnitude_std)
        assert abs(cause.magnitude - other.magnitude) < 2 * doubt, cause.id
