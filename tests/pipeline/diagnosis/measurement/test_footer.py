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
        "measured by Smith, 2024\n",
        "end,of file\n",
        "end, of, the, file\n",
        '"end,of file"\n',
        '"measured by Smith, 2024", Berlin\n',
        "measured by Smith, 2024, Berlin\n",
        ",,end of file\n",
        "stopped by hand, 12:30:05\n",
        "operator,N. N.\nmeasured by Smith,2024\n",
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
        # readings that are cut off or carry their unit
        "12.3 Nm\n",
        "-12.3Nm\n",
        "> 12.3 Nm\n",
        "2 s,0.3 N·m\n",
        "12,3 Nm\n",
        # readings that failed
        "overload\n",
        "Overload,,\n",
        "OVL,0.2\n",
        "overload,overload,overload\n",
        "error,--,--\n",
        "Max, 0.2, 20\n",
        "sensor error,0.2,sensor error\n",
    ],
)
def test_what_may_be_a_reading_is_refused_with_its_line(below: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(HEAD + ROWS + below, encoding="utf-8")
    with pytest.raises(MeasurementError) as refused:
        read_table(path)
    assert refused.value.line == 4


GERMAN = "Zeit [s];Drehmoment [Nm];Winkel [arcsec]\n0,0;0,1;10,5\n1,0;0,2;20,5\n"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-16-le", "cp1252"])
@pytest.mark.parametrize("separator", [";", "\t"])
@pytest.mark.parametrize(
    "below",
    [
        "gemessen von Müller, 2024\n",
        "gemessen von Müller; 2024\n",
        "Ende;der Datei\n",
        '"Ende;der Datei"\n',
        "Ende der Messung;;\n",
        "gemessen von Müller;2024;\n",
    ],
)
def test_german_remarks_are_left_out(
    below: str, separator: str, encoding: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes((GERMAN + below).replace(";", separator).encode(encoding))
    table = read_table(path)
    assert table.numbers["torque_Nm"].tolist() == [0.1, 0.2]
    assert table.read_as.footer == (4,)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
@pytest.mark.parametrize("separator", [";", "\t"])
@pytest.mark.parametrize(
    "below", ["12,3 Nm\n", "2,0;12,3 Nm;\n", "12,3 Nm;;\n", "Überlast;;\n", "Max;0,2;20,5\n"]
)
def test_german_readings_are_refused(
    below: str, separator: str, encoding: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes((GERMAN + below).replace(";", separator).encode(encoding))
    with pytest.raises(MeasurementError) as refused:
        read_table(path)
    assert refused.value.line == 4
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(("below", "left"), [("end,of file\n", True), ("B,of file\n", False)])
def test_words_below_labels_are_a_remark_unless_the_label_is_known(
    below: str, left: bool, tmp_path: Path
) -> None:
    path = tmp_path / "a.csv"
    path.write_text("unit,torque_Nm,angle_arcsec\nA,1,10\nB,1,12\n" + below, encoding="utf-8")
    if left:
        assert read_table(path).read_as.footer == (4,)
        return
    with pytest.raises(MeasurementError) as refused:
        read_table(path)
    assert refused.value.line == 4


def test_words_between_rows_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(HEAD + ROWS + "paused\n" + ROWS, encoding="utf-8")
    with pytest.raises(MeasurementError, match="1 field where the header"):
        read_table(path)


def test_a_label_without_its_numbers_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("unit,torque_Nm,angle_arcsec\nA,1,10\nB,1,12\nC,,\n", encoding="utf-8")
    with pytest.raises(MeasurementError, match="is empty"):
        read_table(path)
