"""Numbers that no gear has, in every key, option and column: computed with or refused, in one line."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from bases import CUP, GIVEN, STUDY, head
from example_files import EXAMPLES
from in_process import flexspline

from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import design_from
from flexspline.geometry.ranges import STIFFNESS_Nm_per_rad
from flexspline.geometry.sanity import warnings
from flexspline.geometry.template import template
from flexspline.pipeline.backlash import backlash
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import read_measurement
from flexspline.pipeline.study.load import study_from
from flexspline.results.records import as_json, backlash_record

NUMBERS: tuple[float | int | bool, ...] = (
    0, 0.0, -0.0, -1, 1e-320, 5e-324, 1e-300, 3e-173, 1e-30, 1e-9, 1e9, 1e30, 1e300, 1e308, -1e308,
    math.nan, math.inf, -math.inf, 10**30, 10**400, True, False,
)  # fmt: skip
BASES = {
    "cup": template("cup").replace("# [shaft.keyway]", "[shaft.keyway]").replace("\n# ", "\n"),
    "hat": re.sub(r"(?m)^# (?=\[|\w+ = )", "", template("hat")),
    "keyed": (EXAMPLES / "keyed-shaft.toml").read_text(encoding="utf-8"),
}


def numeric(table: Any) -> Iterator[tuple[Any, Any]]:
    """(container, key) of every number."""
    for key, value in table.items() if isinstance(table, dict) else enumerate(table):
        if isinstance(value, dict | list):
            yield from numeric(value)
        elif isinstance(value, int | float) and not isinstance(value, bool):
            yield table, key


def computed(design: Design, K: float) -> None:
    """All that `backlash --Kb --Ke` does, but for the files; JSON refuses NaN and infinity."""
    list(warnings(design))
    as_json(backlash_record(backlash(design, K, K)))


@pytest.mark.parametrize(
    "base", [pytest.param(b, marks=[pytest.mark.long] * (i > 0)) for i, b in enumerate(BASES)]
)
def test_every_number_of_a_design(base: str) -> None:
    tables = tomllib.loads(BASES[base])
    places = list(numeric(tables))
    assert len(places) > 30
    accepted = 0
    for table, key in places:
        kept = table[key]
        for number in NUMBERS:
            table[key] = number
            try:
                design = design_from(tables)
            except DesignError:  # which is one line: test_bad_designs
                continue
            for K in (*STIFFNESS_Nm_per_rad, 3e4):
                computed(design, K)
            accepted += 1
        table[key] = kept
    assert accepted > len(places) / 10  # zero clearance, no fillet, no holes


@pytest.mark.parametrize("option", ["--Kb", "--Ke"])
def test_every_number_as_a_stiffness(option: str, tmp_path: Path) -> None:
    other = "--Ke" if option == "--Kb" else "--Kb"
    for number in NUMBERS:
        ended = flexspline(
            "backlash", CUP, option, repr(float(min(number, 1e308))), other, 3e4,
            "--out", tmp_path / "out", folder=tmp_path / "none",
        )  # fmt: skip
        fits = number in STIFFNESS_Nm_per_rad
        assert ended.status == (0 if fits else 2), (number, ended)
        if not fits:
            assert f"{option} = " in ended.said[0]
            assert "must be a number from 1e-12 to 1e15 N·m/rad" in ended.said[0]


COLUMNS = {
    "xb1-40-sweep": ("torque_Nm", "angle_arcsec", "time_s", "temperature_C"),
    "size-40-end-points": ("torque_Nm", "angle_plus_arcsec", "angle_minus_arcsec"),
    "xb1-40-specimens": ("stiffness_Nm_per_rad",),
}


def scaled(name: str, factor: float, columns: tuple[str, ...], folder: Path) -> Path:
    """A measured example with some columns times a factor."""
    lines = [s for s in head(name).decode("utf-8").splitlines() if not s.startswith("#")]
    header = lines[0].split(",")
    rows = [s.split(",") for s in lines[1:]]
    for column in columns:
        at = header.index(column)
        for row in rows:
            row[at] = repr(float(row[at]) * factor)
    path = folder / "scaled.csv"
    path.write_text("\n".join([lines[0], *map(",".join, rows)]) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("name", COLUMNS)
@pytest.mark.parametrize("factor", [0.0, 1e-320, 1e-310, 1e-200, 1e-30, 1e20, 1e300])
def test_a_record_of_nothing_is_refused(name: str, factor: float, tmp_path: Path) -> None:
    """All columns, then the first alone; a sweep at no torque is too little data, and no error."""
    for columns in (COLUMNS[name], COLUMNS[name][:1]):
        if factor == 0 and columns == ("torque_Nm",) and "sweep" in name:
            continue
        with pytest.raises(MeasurementError, match=r"measurement needs|must be|is beyond|no rig"):
            read_measurement(scaled(name, factor, columns, tmp_path))


@pytest.mark.parametrize(
    ("column", "factor"),
    [
        ("time_s", 0.0),
        pytest.param("time_s", 1e-25, marks=pytest.mark.long),
        ("temperature_C", 1e-310),
    ],
)
def test_a_channel_of_nothing_is_no_reason_to_stop(
    column: str, factor: float, tmp_path: Path
) -> None:
    path = scaled("xb1-40-sweep", factor, (column,), tmp_path)
    ended = flexspline("diagnose", CUP, path, *GIVEN, "--out", tmp_path / "out", folder=tmp_path)
    assert ended.status in (0, 2), ended


def test_every_number_of_a_study(tmp_path: Path) -> None:
    link = '"bearing.radial_clearance_um" = { of = "load.torque_Nm", times = 2.0, plus = 1.0 }'
    text = STUDY.replace("DESIGN", str(CUP)).replace("[run]", f"[link]\n{link}\n[run]")
    tables = tomllib.loads(text)
    study_from(tables, tmp_path, "study")  # as it stands, it is one
    places = list(numeric(tables))
    assert len(places) > 10
    accepted = 0
    for table, key in places:
        kept = table[key]
        for number in NUMBERS:
            table[key] = number
            try:
                study_from(tables, tmp_path, "study")
            except DesignError:
                continue
            assert math.isfinite(number), key
            assert not isinstance(number, bool), key
            accepted += 1
        table[key] = kept
    assert accepted > 2 * len(places)  # lower ends down to 0, any factor and shift of the link


@pytest.mark.parametrize("amount", ["1e-320", "1e-12", "0.0", "1e5", "nan"])
def test_a_tolerance_that_no_gauge_tells_is_refused(amount: str, tmp_path: Path) -> None:
    text = (
        f'design = "{CUP}"\n[tolerance]\n"flexspline.length_mm" = {{ std = {amount} }}\n'
        '[run]\nmethod = "tolerance"\n'
    )
    with pytest.raises(DesignError, match="must be"):
        study_from(tomllib.loads(text), tmp_path, "study")
