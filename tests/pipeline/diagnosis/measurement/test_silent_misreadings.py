"""What could be read as something else without a word is refused, or is no column of ours."""

from __future__ import annotations

from pathlib import Path

import pytest

from flexspline.pipeline.diagnosis.measurement.column_names import column_name
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.history_reading import history_of
from flexspline.pipeline.diagnosis.measurement.table import read_table


@pytest.mark.parametrize(
    "head",
    [
        "Torque [Nm] x10", "Torque in 0.01 Nm", "Angle [deg] * 1000", "Angle [deg] per 100",
        "Angle [arcsec] div 3600", "Torque milli Nm", "Angle micro rad", "Torque [Nm] (1 V = 10 Nm)",
        "Temp. change [K]", "Delta temperature [K]", "Temperature rise [°C]", "Time remaining [s]",
        "Time step [s]", "Torque change [Nm]", "Half torque [Nm]", "Torque per lobe [Nm]",
    ],
)  # fmt: skip
def test_a_scaled_or_other_quantity_is_no_column_of_ours(head: str) -> None:
    assert column_name(head) is None


@pytest.mark.parametrize("head", ["Torque 1 [Nm]", "Time 1 - default sample rate [s]"])
def test_a_channel_s_number_is_no_scale(head: str) -> None:
    assert column_name(head) is not None


def written(folder: Path, text: str) -> Path:
    path = folder / "rig.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_fractions_beyond_the_last_name_are_refused(tmp_path: Path) -> None:
    rows = "".join(f"{i},91,{60 + i},9,,\n" for i in range(5))
    with pytest.raises(MeasurementError, match="without a name; with decimal commas"):
        read_table(written(tmp_path, "torque_Nm,angle_arcsec,,\n" + rows))


def test_a_table_s_own_count_of_rows_is_none_of_them(tmp_path: Path) -> None:
    rows = "".join(f"{i},0.{i},{10 + i}\n" for i in range(5))
    found = read_table(written(tmp_path, ",torque_Nm,angle_arcsec\n" + rows))
    assert found.numbers["torque_Nm"].tolist() == [0.0, 0.1, 0.2, 0.3, 0.4]


def test_an_unknown_unit_below_a_known_one_is_refused(tmp_path: Path) -> None:
    text = "torque_Nm,angle_arcsec\nlbf,arcsec\n" + "".join(f"0.{i},{i}\n" for i in range(5))
    with pytest.raises(MeasurementError, match="two units"):
        read_table(written(tmp_path, text))


def test_a_mark_that_another_column_makes_a_thousand_of_is_refused(tmp_path: Path) -> None:
    rows = "".join(f"{i}.5;{i + 1},250;1{i}.500\n" for i in range(5))
    with pytest.raises(MeasurementError, match=r"may be 1250 or 1\.250"):
        read_table(written(tmp_path, "time_s;torque_Nm;angle_arcsec\n" + rows))


def stamped(folder: Path, head: str, *times: str) -> Path:
    rows = "".join(f"{t};0.{i};{i}\n" for i, t in enumerate(times))
    return written(folder, f"{head};torque_Nm;angle_arcsec\n{rows}")


def test_two_numbers_may_be_minutes_and_seconds(tmp_path: Path) -> None:
    with pytest.raises(MeasurementError, match="may be hours and minutes or minutes and seconds"):
        read_table(stamped(tmp_path, "time", "00:01", "00:02", "00:03"))


@pytest.mark.parametrize(
    ("head", "times", "seconds"),
    [
        ("Time [mm:ss]", ("00:59", "01:01"), 2.0),
        ("Zeit (min:sek)", ("00:59", "01:01"), 2.0),
        ("Time [hh:mm]", ("00:59", "01:01"), 120.0),
        ("Time [hh:mm:ss]", ("00:59:00", "01:01:00"), 120.0),
        ("time", ("00:58.5", "01:01.0"), 2.5),  # as Excel shows times
        ("time", ("00:58,5", "01:01,0"), 2.5),
        ("time", ("23:59", "24:01"), 2.0),  # no hour
        ("time", ("2024-01-01 00:59", "2024-01-01 01:01"), 120.0),
    ],
)  # fmt: skip
def test_what_says_which_of_the_two(
    head: str, times: tuple[str, str], seconds: float, tmp_path: Path
) -> None:
    found = read_table(stamped(tmp_path, head, *times)).numbers["time_s"]
    assert found.tolist() == [0.0, seconds]


@pytest.mark.parametrize(
    "form",
    ["hh:mm:ss", "hh:mm:ss,ms", "hh:mm:ss.ms", "hh:mm:ss:ms", "hh:mm:ss,fff", "hh:mm:ss,000", "HH:mm:ss.SSS"],
)  # fmt: skip
@pytest.mark.parametrize("row", [False, True], ids=["in the head", "below it"])
@pytest.mark.parametrize("mark", [",", ".", ":"])
def test_parts_of_a_second_in_the_form_of_a_time_of_day(
    form: str, row: bool, mark: str, tmp_path: Path
) -> None:
    head = (
        "Zeit;Moment;Winkel\n[{}];[Nm];[arcsec]\n" if row else "Zeit [{}];torque_Nm;angle_arcsec\n"
    )
    body = "".join(
        f"09:58:{s}{mark}{ms};1,5;{ms}\n" for s, ms in (("07", 250), ("08", 300), ("08", 350))
    )
    found = read_table(written(tmp_path, head.format(form) + body)).numbers["time_s"]
    assert found == pytest.approx([0.0, 1.05, 1.1])


def test_milliseconds_after_minutes_and_seconds(tmp_path: Path) -> None:
    found = read_table(stamped(tmp_path, "Zeit [mm:ss,ms]", "10:59,500", "11:01,250"))
    assert found.numbers["time_s"].tolist() == [0.0, 1.75]


@pytest.mark.parametrize(
    ("head", "times", "seconds"),
    [
        ("Zeit [mm:ss:ms]", ("12:30:500", "12:31:250"), 0.75),
        ("time", ("12:30:500", "12:31:250"), 0.75),  # three digits are no hundredths
        ("time_hh:mm:ss", ("00:59:00", "01:01:00"), 120.0),  # as the list of what is accepted names it
        ("Time [hh:mm:ss.mmm]", ("00:00:01.250", "00:00:02.300"), 1.05),
        ("Time [hh:mm:ss,µs]", ("00:00:01,250000", "00:00:02,300000"), 1.05),
        ("Time (%H:%M:%S.%f)", ("00:00:01.250000", "00:00:02.300000"), 1.05),
        ("Time [yyyy-mm-dd hh:mm:ss]", ("2026-01-02 00:00:01", "2026-01-02 00:01:00"), 59.0),
        ("Zeit [TT.MM.JJJJ hh:mm:ss]", ("02.01.2026 00:00:01", "02.01.2026 00:01:00"), 59.0),
        ("time", ("23:59:59", "24:00:01"), 2.0),  # time since the start
        ("time", ("33:58:07", "100:00:00"), 66 * 3600 + 113.0),
        ("time", ("12:00:00Z", "12:00:05Z"), 5.0),
        ("time", ("2026-01-01 23:59:59", "2026-01-02"), 1.0),  # a sheet leaves out midnight's time
    ],
)  # fmt: skip
def test_other_forms_of_a_time(
    head: str, times: tuple[str, str], seconds: float, tmp_path: Path
) -> None:
    found = read_table(stamped(tmp_path, head, *times)).numbers["time_s"]
    assert found.tolist() == pytest.approx([0.0, seconds])


@pytest.mark.parametrize("form", ["yyyy-mm-dd hh:mm:ss", "hh:mm:ss.xxx", "%H:%M:%S.%f"])
def test_a_form_of_a_time_in_the_row_of_units(form: str, tmp_path: Path) -> None:
    rows = "".join(f"2026-01-02 00:00:0{i}.500000;0.{i};{i}\n" for i in range(3))
    text = f"Zeit;Moment;Winkel\n{form};Nm;arcsec\n{rows}"
    assert read_table(written(tmp_path, text)).numbers["time_s"].tolist() == [0.0, 1.0, 2.0]


@pytest.mark.parametrize(
    ("head", "times", "reason"),
    [
        ("Time [hh:mm:ss]", ("05:30", "05:31"), "has two numbers, not hh:mm:ss"),
        ("Time [hh:mm:ss,ms]", ("05:30,100", "05:30,200"), "has two numbers, not hh:mm:ss"),
        ("Time [mm:ss:ff]", ("00:05:30", "00:05:31"), "has three numbers, not mm:ss"),
        ("Time [hh:mm:ss,ms]", ("00:00:01,998", "00:00:02,3"), "may be 003 or 300; write all 3 digits"),
        ("time", ("23:59:59", "2026-01-02 00:00:00"), "is not a date and time as"),
        ("time", ("12:30:00", "12:31"), "is not a date and time as"),
        ("time", ("12:30:00Z", "12:31:00+01:00"), "is not a date and time as"),
        ("time", ("12:30:00", "12:61:00"), "minutes and seconds to 59"),
        ("time", ("12:61:00", "12:62:00"), "minutes and seconds to 59"),
        ("time", ("2026-01-02 24:00:00", "2026-01-03 00:00:01"), "00:00 of the next day"),
    ],
)  # fmt: skip
def test_times_that_are_not_as_the_head_or_the_first_says(
    head: str, times: tuple[str, str], reason: str, tmp_path: Path
) -> None:
    with pytest.raises(MeasurementError, match=reason):
        read_table(stamped(tmp_path, head, *times))


@pytest.mark.parametrize("rows", ["00:00:01,250,1.5,3", '"00:00:01,250",1.5,3,'])
def test_a_form_cut_at_its_comma_is_refused(rows: str, tmp_path: Path) -> None:
    text = f"Zeit [hh:mm:ss,ms],torque_Nm,angle_arcsec\n{rows}\n{rows}\n"
    with pytest.raises(MeasurementError, match="are the parts of one time"):
        read_table(written(tmp_path, text))


def test_times_past_midnight_are_refused_with_what_to_do(tmp_path: Path) -> None:
    path = stamped(tmp_path, "time", "23:59:58", "23:59:59", "00:00:00")
    with pytest.raises(MeasurementError, match="past midnight"):
        history_of(read_table(path))


@pytest.mark.parametrize("head", ["-Torque [Nm]", "− Torque in Nm", "Angle (1/100 deg)"])
def test_a_sign_or_a_share_before_the_unit_is_no_column_of_ours(head: str) -> None:
    assert column_name(head) is None
