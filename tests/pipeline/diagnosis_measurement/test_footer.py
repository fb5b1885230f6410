"""Words below the last row, as recording programs write them, are no reading; all else is checked as one."""

from __future__ import annotations

from pathlib import Path

import pytest

from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.table import read_table
from flexspline.results.diagnosis.reading import reading_notes

HEAD = "time_s,torque_Nm,angle_arcsec\n"
ROWS = "0,0.1,10\n1,0.2,20\n"


@pytest.mark.parametrize(
    "below",
    [
        "End of record\n",
        "*** Ende der Messung ***,,\n",
        '"operator, night shift"\n\nstopped by hand\n',
        "\nchecked: N. N.\n\n",
    ],
)
def test_remarks_are_left_out_and_said(below: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(HEAD + ROWS + below, encoding="utf-8")
    table = read_table(path)
    assert table.numbers["torque_Nm"].tolist() == [0.1, 0.2]
    assert any("below the last row" in note for note in reading_notes(table.read_as))
    assert table.read_as.footer[0] >= 4


@pytest.mark.parametrize(
    "below",
    [
        "Max,0.2,20\n",  # a summary: numbers that a rig did not read
        "2,overload,30\n",
        "nan\n",
        "2\n",
        "12:30:05\n",
        "?\n",
    ],
)
def test_what_may_be_a_reading_is_refused_with_its_line(below: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(HEAD + ROWS + below, encoding="utf-8")
    with pytest.raises(MeasurementError) as refused:
        read_table(path)
    assert refused.value.line == 4


def test_words_between_rows_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(HEAD + ROWS + "paused\n" + ROWS, encoding="utf-8")
    with pytest.raises(MeasurementError, match="1 fields"):
        read_table(path)


def test_a_label_without_its_numbers_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("unit,torque_Nm,angle_arcsec\nA,1,10\nB,1,12\nC,,\n", encoding="utf-8")
    with pytest.raises(MeasurementError, match="is empty"):
        read_table(path)
