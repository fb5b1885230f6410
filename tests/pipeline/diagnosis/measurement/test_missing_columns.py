"""What a file is told whose columns make no measurement: the column's fault, or what the header has."""

from __future__ import annotations

from pathlib import Path

import pytest

from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import (
    EndPoints,
    Specimens,
    read_measurement,
)

SWEEP = "".join(f"{m},{a}\n" for m, a in ((0, 0), (5, 100), (0, 0), (-5, -100), (0, 0)))
ENDS = "A;6.4;43;-43\nA;40;65;-65\nB;6.4;47;-47\nB;40;66;-66\n"
ANGLES = 'Drehmoment [Nm];Winkel + ["];Winkel - ["]'


def of(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "rig.csv"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("head", "said"),
    [
        ("Torque [Nm],Angle (xyz)", '"xyz" is not a known unit of it'),
        ("Torque [Nm],Angle [xyz]", '"xyz" is not a known unit of it'),
        ("Torque (xyz),Angle (deg)", '"xyz" is not a known unit of it'),
        ("Torque [Nm],Angle xyz", "it has no unit"),
        ("扭矩(Nm),角度(xyz)", '"xyz" is not a known unit of it'),
    ],
)
def test_an_unknown_unit_is_said_in_any_brackets(head: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(MeasurementError, match=said) as refused:
        read_measurement(of(tmp_path, f"{head}\n{SWEEP}"))
    assert refused.value.line == 1
    assert "accepted are" in str(refused.value)


@pytest.mark.parametrize("head", ["Torque [Nm],Voltage (V)", "Torque [Nm],Angle rate (xyz)"])
def test_another_quantity_is_no_unknown_unit(head: str, tmp_path: Path) -> None:
    with pytest.raises(MeasurementError, match="column angle_arcsec is missing for a torque sweep"):
        read_measurement(of(tmp_path, f"{head}\n{SWEEP}"))


@pytest.mark.parametrize(
    "word", ["Prüfling", "Einheit", "Gerät", "Exemplar", "Getriebe", "Muster", "Probe", "specimen"]
)
def test_end_points_name_their_gears_in_any_of_these_words(word: str, tmp_path: Path) -> None:
    found = read_measurement(of(tmp_path, f"{word};{ANGLES}\n{ENDS}"))
    assert isinstance(found, EndPoints)
    assert found.unit == ("A", "A", "B", "B")


def test_specimens_may_be_named_like_gears(tmp_path: Path) -> None:
    found = read_measurement(of(tmp_path, "Prüfling;Steifigkeit [Nm/rad]\n1;30000\n2;31000\n"))
    assert isinstance(found, Specimens)
    assert found.specimen == ("1", "2")


def test_end_points_without_names_are_told_what_is_missing_and_what_there_is(
    tmp_path: Path,
) -> None:
    with pytest.raises(MeasurementError) as refused:
        read_measurement(of(tmp_path, f"Wer;{ANGLES}\n{ENDS}"))
    said = str(refused.value)
    assert "column unit (name or number of the gear measured) is missing for end points" in said
    assert 'the header in line 1 has: Wer, Drehmoment [Nm], Winkel + ["], Winkel - ["]' in said
