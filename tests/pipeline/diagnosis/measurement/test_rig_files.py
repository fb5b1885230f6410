"""Files as rigs and spreadsheets write them, byte for byte: the same numbers, or refused in one line."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import Sweep, read_measurement
from flexspline.pipeline.diagnosis.measurement.table import read_table
from flexspline.results.diagnosis.reading import reading_notes

TORQUE = [0.0, 0.25, 0.5, 1.125, 0.5, 0.25, -0.25, -0.5, -1.125, -0.5, -0.25, 0.0]
ANGLE = [11.25 * t + 36 * ((t > 0) - (t < 0)) for t in TORQUE]  # arcsec
TIME = [0.5 * i for i in range(len(TORQUE))]
ROWS = list(zip(TORQUE, ANGLE, TIME, strict=True))


def point(value: float) -> str:
    return f"{value:.5f}"


def comma(value: float) -> str:
    return point(value).replace(".", ",")


def german(value: float) -> str:
    return f"{value:,.2f}".translate(str.maketrans(",.", ".,"))


def body(
    separator: str = ",", number: Callable[[float], str] = point, quote: str = "", end: str = "\n"
) -> str:
    return "".join(separator.join(quote + number(v) + quote for v in row) + end for row in ROWS)


OURS = "torque_Nm,angle_arcsec,time_s\n"
GERMAN = 'Drehmoment [Nm];Winkel ["];Zeit [s]\n'
READ: dict[str, bytes] = {
    "as the contract says": (OURS + body()).encode(),
    "German Excel": (GERMAN + body(";", comma)).replace("\n", "\r\n").encode("cp1252"),
    "German, quoted, by commas":
        ('"Drehmoment [Nm]","Winkel [″]","Zeit [s]"\n' + body(",", comma, '"')).encode(),
    "tabs": ("torque_Nm\tangle_arcsec\ttime_s\n" + body("\t")).encode(),
    "brackets": ("Torque [Nm],Angle [arcsec],Time [s]\n" + body()).encode(),
    "parentheses": ("Torque (N·m),Angle (arc sec),Time (s)\n" + body()).encode(),
    "units below": ("Torque,Angle,Time\nN·m,arcsec,s\n" + body()).encode(),
    "units below, in brackets": ("Drehmoment;Winkel;Zeit\n[Nm];[″];[s]\n" + body(";", comma)).encode(),
    "symbols over units": ("M\tφ\tt\nNm\tarcsec\ts\n" + body("\t")).encode(),
    "notes above":
        ("Rig 7;J. Smith\nDate;12.03.2024\nTorque range: 5 Nm\n\n" + GERMAN + body(";", comma)).encode(),
    "a logger's channel names": ("Zeit  1 - Default sample rate\tMD_Abtrieb Drehmoment\tWinkel Abtrieb\n"
        "s\tN·m\tarcsec\n" + "".join(f"{t}\t{m}\t{a}\n" for m, a, t in ROWS)).encode("cp1252"),
    "a measuring program's own header": ("LabVIEW Measurement\t\nDate\t2024/05/01\n***End_of_Header***\t\n\n"
        "X_Value\tTorque [Nm]\tAngle [arcsec]\tTime [s]\tComment\n"
        + "".join(f"0\t{m}\t{a}\t{t}\t\n" for m, a, t in ROWS)).encode(),
    "Excel's first line": ("sep=;\n" + GERMAN + body(";", comma)).encode("utf-8-sig"),
    "Czech Excel": ('Krouticí moment [Nm];Úhel ["];Čas [s]\n' + body(";", comma)).encode("cp1250"),
    "Chinese Excel": ("扭矩(N·m),角度(arcsec),时间(s)\n" + body()).encode("gb18030"),
    "Japanese Excel": ("トルク[Nm],角度[arcsec],時間[s]\n" + body()).encode("cp932"),
    "UTF-8 with mark": (OURS + body()).encode("utf-8-sig"),
    "UTF-16, little end first":
        ("\ufeff" + GERMAN.replace(";", "\t") + body("\t", comma)).encode("utf-16-le"),
    "UTF-16, big end first": ("\ufeff" + GERMAN + body(";", comma)).encode("utf-16-be"),
    "UTF-16 without mark": (OURS + body()).encode("utf-16-le"),
    "Latin-1": ("Prüfer: Müller\n" + OURS + body()).encode("latin-1"),
    "carriage returns": (OURS + body()).replace("\n", "\r").encode(),
    "separators at the ends":
        ("torque_Nm;angle_arcsec;time_s;\n" + body(";", end=";\n") + ";;;\n\n;;;\n").encode(),
    "no separator at the rows' ends": ("torque_Nm;angle_arcsec;time_s;;\n" + body(";")).encode(),
    "head in a comment": ("# by numpy.savetxt\n# torque_Nm,angle_arcsec,time_s\n" + body()).encode(),
    "comments between": (OURS + body().replace("\n", "\n# pause\n", 3)).encode(),
    "an empty channel": ("torque_Nm,angle_arcsec,time_s,temperature_C\n" + body(end=",\n")).encode(),
    "NaN in a whole channel": ("torque_Nm,angle_arcsec,time_s,temperature_C\n" + body(end=",NaN\n")).encode(),
    "true minus signs": (OURS + body()).replace("-", "−").encode(),
    "a setpoint beside": ("Torque setpoint [Nm],torque_Nm,angle_arcsec,time_s\n"
                          + "".join("9," + ",".join(map(point, r)) + "\n" for r in ROWS)).encode(),
    "our name beside another": ("Torque sensor 2 [Nm],torque_Nm,angle_arcsec,time_s\n"
                                + "".join("9," + ",".join(map(point, r)) + "\n" for r in ROWS)).encode(),
    "exponents": (OURS + body(number=lambda v: f"{v:.6E}")).encode(),
    "exponents with commas": (GERMAN + body(";", lambda v: f"{v:.3E}".replace(".", ","))).encode(),
    "ISO stamps": ("Timestamp,torque_Nm,angle_arcsec\n" + "".join(
        f"2024-05-01T23:59:{57.5 + t:06.3f},{m},{a}\n" for m, a, t in ROWS if t < 2.5) + "".join(
        f"2024-05-02T00:00:{t - 2.5:06.3f},{m},{a}\n" for m, a, t in ROWS if t >= 2.5)).encode(),
    "dotted dates": ("Zeit;M [Nm];Winkel [″]\n" + "".join(
        f"1.5.2024 12:00:{t:06.3f};{comma(m)};{comma(a)}\n" for m, a, t in ROWS).replace(":0",
            ":0")).encode(),
    "day and time apart": ("Datum;Uhrzeit;M [Nm];Winkel [″]\n" + "".join(
        f"01.05.2024;12:00:{comma(t).rjust(8, '0')};{comma(m)};{comma(a)}\n" for m, a, t in ROWS)).encode(),
}  # fmt: skip


def read(tmp_path: Path, data: bytes, **more: float) -> Sweep:
    path = tmp_path / "rig.csv"
    path.write_bytes(data)
    found = read_measurement(path, **more)
    assert isinstance(found, Sweep)
    return found


@pytest.mark.parametrize("name", READ)
def test_each_form_gives_the_same_numbers(name: str, tmp_path: Path) -> None:
    found = read(tmp_path, READ[name])
    # one form has four digits: half of the last, of 48.66 arcsec
    assert found.history.torque_Nm == pytest.approx(TORQUE, abs=1e-9)
    assert found.angle_arcsec == pytest.approx(ANGLE, abs=5.1e-3)
    assert found.history.time_s == pytest.approx(TIME, abs=1e-9)
    assert found.history.temperature_C is None


# what one of each unit is, by its definition
UNITS = {
    "torque": {"Nm": 1, "mNm": 1e-3, "Nmm": 1e-3, "Ncm": 1e-2, "kNm": 1e3, "µNm": 1e-6,
               # NIST SP 811 (2008), appendix B.8: to the seven digits given there
               "in-lbf": 1.129848e-1, "ft-lbf": 1.355818, "oz-in": 7.061552e-3, "kgf.m": 9.80665,
               "kgf.cm": 9.80665e-2},
    "angle":
        {"arcsec": 1, "arcmin": 60, "deg": 3600, "°": 3600, "″": 1, "′": 60, "mdeg": 3.6, "gon": 0.9 * 3600,
              "rad": 3600 * math.degrees(1), "mrad": 3.6 * math.degrees(1), "urad": 3.6e-3 * math.degrees(1),
              "turns": 360 * 3600},
    "time": {"s": 1, "ms": 1e-3, "us": 1e-6, "min": 60, "h": 3600},
}  # fmt: skip


@pytest.mark.parametrize(("quantity", "unit"), [(q, u) for q in UNITS for u in UNITS[q]])
def test_units_are_exact(quantity: str, unit: str, tmp_path: Path) -> None:
    ours = {"torque": "Nm", "angle": "arcsec", "time": "s"}
    head = ",".join(f"{q} [{unit if q == quantity else u}]" for q, u in ours.items())
    found = read(tmp_path, (head + "\n" + body()).encode())
    values = {
        "torque": found.history.torque_Nm,
        "angle": found.angle_arcsec,
        "time": found.history.time_s,
    }
    given = {"torque": TORQUE, "angle": ANGLE, "time": TIME}
    for q in ours:
        # rounding of one product; of the table's seventh digit
        wanted = np.array(given[q]) * (UNITS[q][unit] if q == quantity else 1)
        rel = 4e-7 if unit in ("in-lbf", "ft-lbf", "oz-in") else 1e-15
        assert values[q] == pytest.approx(wanted, rel=rel, abs=1e-30)
    read_as = next(c for c in found.read_as.columns if c.name.startswith(quantity))
    assert read_as.factor == pytest.approx(UNITS[quantity][unit], rel=rel)


def test_kelvin(tmp_path: Path) -> None:
    data = "torque_Nm,angle_arcsec,time_s,Temperature [K]\n" + body(end=",294.65\n")
    assert read(tmp_path, data.encode()).history.temperature_C == pytest.approx(21.5, abs=1e-9)


@pytest.mark.parametrize("unit", ["°C", "K"])
@pytest.mark.parametrize("celsius", [-273.15, 1000.0])
def test_a_temperature_s_limits_are_in_the_file_s_unit(
    unit: str, celsius: float, tmp_path: Path
) -> None:
    off = 273.15 if unit == "K" else 0.0
    low, high = ("0", "1273.15") if unit == "K" else ("-273.15", "1000")
    head = f"torque_Nm,angle_arcsec,time_s,Temperature [{unit}]\n"
    at_limit = read(tmp_path, (head + body(end=f",{celsius + off:.2f}\n")).encode())
    assert at_limit.history.temperature_C == pytest.approx(celsius)
    beyond = celsius + off + math.copysign(0.01, celsius)
    with pytest.raises(MeasurementError) as refusal:
        read(tmp_path, (head + body(end=f",{beyond:.2f}\n")).encode())
    said = f":2: Temperature [{unit}] = {beyond:.9g} (the first of {len(ROWS)} such rows): must be "
    assert said + f"from {low} to {high} {unit};" in str(refusal.value)


@pytest.mark.parametrize(("unit", "per_second"), [("s", 1), ("ms", 1000), ("us", 1_000_000)])
def test_a_time_since_1970_is_read_in_any_unit(unit: str, per_second: int, tmp_path: Path) -> None:
    since = 1_700_000_000 * per_second
    rows = "".join(f"{since + round(t * per_second)},{m},{a}\n" for m, a, t in ROWS if t % 1 == 0)
    data = f"Timestamp [{unit}],torque_Nm,angle_arcsec\n{rows}"
    time = read(tmp_path, data.encode()).history.time_s
    assert time == pytest.approx([1.7e9 + t for t in TIME if t % 1 == 0], rel=1e-15)
    too_large = f"Timestamp [{unit}],torque_Nm,angle_arcsec\n{1.1e12 * per_second:.0f},1,2\n"
    with pytest.raises(
        MeasurementError, match=rf"is beyond ±1e\+{len(str(per_second)) + 11} {unit}$"
    ):
        read(tmp_path, too_large.encode())


def test_encoder_counts_want_their_number_in_a_turn(tmp_path: Path) -> None:
    rows = "".join(f"{t},{round(10 * a)}\n" for t, a in zip(TORQUE, ANGLE, strict=True))
    data = ("Torque [Nm],Encoder [counts]\n" + rows).encode()
    with pytest.raises(MeasurementError, match="--counts-per-turn N"):
        read(tmp_path, data)
    found = read(tmp_path, data, counts_per_turn=12_960_000)  # a tenth of an arcsec each
    assert found.angle_arcsec == pytest.approx(ANGLE, abs=0.05)
    for wrong in (0, -4, math.nan, math.inf):
        with pytest.raises(MeasurementError, match=r"--counts-per-turn = .*: must be from 1"):
            read(tmp_path, data, counts_per_turn=wrong)
    with pytest.raises(MeasurementError, match="no column has counts"):
        read(tmp_path, (OURS + body()).encode(), counts_per_turn=4096)


def test_thousands(tmp_path: Path) -> None:
    """Grouped digits are read where the file's decimal mark is sure."""
    for head, number in (
        (GERMAN, german),
        ("torque_Nm;angle_arcsec;time_s\n", lambda v: f"{v:,.2f}"),
    ):
        thousand = "".join(";".join(number(1000 * v) for v in row) + "\n" for row in ROWS)
        found = read(tmp_path, (head + thousand).encode())
        assert found.angle_arcsec == pytest.approx(1000 * np.array(ANGLE), abs=0.01)
    spaced = "".join(
        ";".join(f"{1e6 * v:,.2f}".replace(",", " ").replace(".", ",") for v in r) + "\n"
        for r in ROWS
    )
    found = read(tmp_path, (GERMAN + spaced).encode())
    assert found.history.torque_Nm == pytest.approx(1e6 * np.array(TORQUE), rel=1e-6)


@pytest.mark.parametrize(
    ("head", "again", "lines"),
    [
        (OURS, OURS, (8,)),
        ("Torque,Angle,Time\nN·m,arcsec,s\n", "Torque,Angle,Time\n", (9,)),
        ("Torque,Angle,Time\nN·m,arcsec,s\n", "Torque, Angle,Time,\nN·m,arcsec,s\n", (9, 10)),
        ("Torque,Angle,Time\nN·m,arcsec,s\nfloat,float,float\n", "", (3,)),
        (OURS + "double,double,datetime\n", "", (2,)),
    ],
)
def test_the_header_again_is_passed_over_and_said(
    head: str, again: str, lines: tuple[int, ...], tmp_path: Path
) -> None:
    rows = body().splitlines(keepends=True)
    found = read(tmp_path, (head + "".join(rows[:6]) + again + "".join(rows[6:])).encode())
    assert found.history.torque_Nm == pytest.approx(TORQUE)
    assert found.angle_arcsec == pytest.approx(ANGLE, abs=1e-5)
    assert found.read_as.heads_again == lines
    assert any(
        f"repeated header or data types: line {lines[0]}" in note
        for note in reading_notes(found.read_as)
    )


def test_one_column_with_quoted_decimal_commas(tmp_path: Path) -> None:
    path = tmp_path / "torque.csv"
    path.write_text('Drehmoment [Nm]\n"1,5"\n"-3"\n', encoding="utf-8")
    assert read_table(path).numbers["torque_Nm"].tolist() == [1.5, -3]


REFUSED = {
    "a thousand or a thousandth":
        (GERMAN + "1,234;5;6\n" * 9, ':2: Drehmoment [Nm] = "1,234" may be 1234 or 1.234'),
    "point and comma":
        (GERMAN + "0,5;1;2\n" * 5 + "0.5;1;2\n", ':7: Drehmoment [Nm] = "0.5" has a decimal point'),
    "two torques":
        ("Torque A [Nm],Torque B [Nm],angle_arcsec\n1,2,3\n", '"Torque A [Nm]" and "Torque B [Nm]" both fit'),
    "two units": ("Torque [Nm],Angle [deg]\nmNm,deg\n1,2\n", "two units"),
    "no unit": ("Drehmoment;Winkel [°]\n1;2\n", "column Drehmoment: accepted are torque_Nm"),
    "an unknown unit": ("Torque [lbf·s],Angle [deg]\n1,2\n", '"lbf·s" is not a known unit'),
    "degrees or gon": ("Torque [Nm],Angle [grad]\n1,2\n", "angle_deg or angle_gon"),
    "an unknown unit below the head":
        ("Rig\nZeit;M [Nm];Winkel\nfortnight;Nm;deg\n1;1;2\n", ':3: column Zeit: accepted are time_s, '
         'time_ms, time_us, time_min, time_h, hh:mm:ss; "fortnight" is not a known unit'),
    "an unknown unit in the head, others below":
        ("Rig\nZeit [fortnight];M;Winkel\n;Nm;deg\n1;1;2\n", ':2: column Zeit [fortnight]: accepted'),
    "a unit of something else": ("Torque [deg],Angle [deg]\n1,2\n", '"deg" is not a known unit'),
    "day or month first":
        ("Time,torque_Nm,angle_arcsec\n" + "05/01/2024 12:00:00,1,2\n" * 9, "the day or the month"),
    "days only": ("Datum;torque_Nm;angle_arcsec\n" + "01.05.2024;1;2\n" * 9, "a day without a time of day"),
    "a strange stamp":
        ("Zeit;torque_Nm;angle_arcsec\n" + "12:00:01;1;2\n" * 9 + "noon;1;2\n", ':11: Zeit = "noon"'),
    "gaps":
        ("torque_Nm,angle_arcsec,temperature_C\n" + "1,2,20\n1,2,\n" * 9, "9 of 18 rows lack a reading"),
    "unquoted decimal commas":
        ("torque_Nm,angle_arcsec\n" + "0,5,1,5\n" * 9, "with decimal commas, separate"),
    "decimal commas in one column":
        ("Drehmoment [Nm]\n1,5\n-3\n", ":2: 2 fields where the header has 1; with decimal commas, put the "
         "numbers in quotation marks or write decimal points"),
    "spaces": ("torque_Nm angle_arcsec\n1 2\n", "separated by commas, semicolons or tabs"),
    "a number with its unit": ("torque_Nm;angle_arcsec\n" + "1 Nm;2\n" * 9, '"1 Nm" is not a finite number'),
    "a quoted line break": ('torque_Nm,angle_arcsec,remark\n1,2,"a\nb"\n', ":2: a quoted field goes on"),
    "a quotation mark that never closes":
        ('torque_Nm,angle_arcsec\n' + '"1",2\n# pause\n' * 9 + '1,"2\n' + "1,2\n" * 9,
         ":20: a quotation mark opens here and never closes"),
    "the same in the last line":
        ('torque_Nm,angle_arcsec\n1,2\n"1,2\n', ":3: a quotation mark opens here and never closes"),
    "the same in a long file":
        ('torque_Nm,angle_arcsec\n1,"2\n' + "1,2\n" * 50_000, ":2: a quotation mark opens here and never"),
    "a quotation mark that the next one closes":
        ('torque_Nm,angle_arcsec\n1,2\n"1,2\n1,2\n"1",2\n', ":3: a quoted field goes on in the next line"),
    "letters after a quotation":
        ('torque_Nm,angle_arcsec\n1,2\n"1"2,2\n', ":3: ',' expected after"),
    "no column known": ("Kraft [N];Weg [mm]\n1;2\n", "the header in line 1 has: Kraft [N], Weg [mm]"),
    "Arabic figures": ("torque_Nm,angle_arcsec\n١,٢\n", "is not a finite number"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_two_readings_fit_is_refused_in_one_line(name: str, tmp_path: Path) -> None:
    data, needle = REFUSED[name]
    with pytest.raises(MeasurementError) as refusal:
        read(tmp_path, data.encode())
    assert needle in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_an_encoder_that_passes_a_full_turn_is_told_from_a_wrong_unit(tmp_path: Path) -> None:
    for unit, turn in (("deg", 360.0), ("rad", math.tau)):
        per_arcsec = turn / 1_296_000
        rows = "".join(
            f"{t},{a * per_arcsec % turn:.9f}\n" for t, a in zip(TORQUE, ANGLE, strict=True)
        )
        with pytest.raises(MeasurementError) as refusal:
            read(tmp_path, f"Torque [Nm],Angle [{unit}]\n{rows}".encode())
        # the angle is negative from the seventh row on, and 0 in the last
        said = f":8: Angle [{unit}] jumps by 360° here, the first of 2 times: did the encoder pass"
        assert said in str(refusal.value)


@pytest.mark.parametrize(
    ("begin", "needle"),
    [(b"\xd0\xcf\x11\xe0" + bytes(600), "old Excel file"), (b"TDSm\0\0", "TDMS"), (b"PK\x03\x04zip",
        "not a readable .xlsx"),
     (b"\xff\xfet", "begins as UTF-16"),
     (b"torque\x81,angle\n", "not text in UTF-8, cp1252, cp1250, gb18030 or cp932"),
    (b"\xe7,\x81\n", "byte 0x81 is not text in UTF-8, cp1252, cp1250, gb18030 or cp932"),
         (b"\x1f\x8b\x08", "compressed")],
)  # fmt: skip
def test_other_files_are_named(begin: bytes, needle: str, tmp_path: Path) -> None:
    with pytest.raises(MeasurementError, match=needle):
        read(tmp_path, begin)


@pytest.mark.parametrize(
    ("text", "needle"),
    [
        (body(), "write the columns' names above them"),
        ("torque_Nm|angle_arcsec|time_s\n" + body("|"), "separate the columns by commas"),
    ],
)
def test_a_header_without_names_is_answered_with_what_to_write(
    text: str, needle: str, tmp_path: Path
) -> None:
    with pytest.raises(MeasurementError, match=needle):
        read(tmp_path, text.encode())


def test_what_is_read_is_said(tmp_path: Path) -> None:
    data = "Rig\nDrehmoment;Winkel;Zeit;Raum\nmNm;°;s;m\n" + body(";", comma, end=";1\n")
    said = read(tmp_path, data.encode("utf-16")).read_as
    assert [(c.head, c.name, c.unit) for c in said.columns] == [
        ("Drehmoment", "torque_Nm", "mNm"), ("Winkel", "angle_arcsec", "deg"), ("Zeit", "time_s", "s"),
    ]  # fmt: skip
    assert said.ignored == ("Raum",)
    assert (said.encoding, said.separator, said.decimal_mark) == ("UTF-16", "semicolon", ",")
    assert (said.head_line, said.unit_row) == (2, True)
