"""How many units and specimens a report says were measured."""

from __future__ import annotations

from pathlib import Path

from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.results.report.compared import measured

CUP = load_design(EXAMPLES / "xb1-40.toml")


def test_units_are_counted_and_not_their_rows(tmp_path: Path) -> None:
    path = tmp_path / "m.csv"
    rows = [f"{unit},{torque},80,-80" for unit in "ABCDEF" for torque in (1, 2, 4)]
    path.write_text("\n".join(["unit,torque_Nm,angle_plus_arcsec,angle_minus_arcsec", *rows]))
    assert dict(measured(diagnose_file(CUP, path, 31329, 43339)))["Units"] == "6 (18 rows)"


def test_units_with_a_row_each_are_counted_alone() -> None:
    path = EXAMPLES / "measured" / "size-40-end-points.csv"
    assert dict(measured(diagnose_file(CUP, path, 31329, 43339)))["Units"] == "4"
