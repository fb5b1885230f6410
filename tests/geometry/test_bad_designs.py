"""Every bad design file is refused with one line: its key, its value, and the range that works.

Ranges were worked out by hand from the geometry (docs/contract.md) of the two examples:
xb1-40: Ri = 19.2, Rw = 19.6, L = 30, ring 8 long, boss r = 9, bore r = 4, diaphragm 0.6, wall 0.4;
hat-25: Ri = 28.8, Rw = 29.3, L = 28, ring from 16 to 27, flange r = 39 to 48, diaphragm 0.5;
keyed-shaft: segments of 4, 12, 20 mm, r = 10, 9, 8, bore r = 3, keyway 5 x 3 x 16.
"""

# ruff: noqa: E501  (one row per bad design reads better than four lines each)
from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import pytest
from changed_text import changed_text

from flexspline.geometry.errors import DesignError, DesignFileError
from flexspline.geometry.input_file import LARGEST_TOML_BYTES
from flexspline.geometry.load import load_design


@dataclass(frozen=True)
class Bad:
    """Changes to an example, and what the line must say: key, value, range."""

    example: str
    changes: dict[str, str | None]
    says: tuple[str, ...]

    @property
    def id(self) -> str:
        return " ".join(f"{k}={str(v)[:16]}" for k, v in self.changes.items())


def cup(says: tuple[str, ...], **changes: str | None) -> Bad:
    return Bad("xb1-40", {k.replace("__", "."): v for k, v in changes.items()}, says)


def hat(says: tuple[str, ...], **changes: str | None) -> Bad:
    return Bad("hat-25", {k.replace("__", "."): v for k, v in changes.items()}, says)


def shaft(says: tuple[str, ...], **changes: str) -> Bad:
    """Of the keyed shaft; ``s0``, ``s1``, ``s2`` are its segments."""
    dotted = {}
    for key, value in changes.items():
        segment, _, rest = key.partition("__")
        if segment in ("s0", "s1", "s2"):
            dotted[f"shaft.segment[{segment[1]}].{rest}"] = value
        else:
            dotted["shaft." + key.replace("__", ".")] = value
    return Bad("keyed-shaft", dotted, says)


ONE_KEY = [
    cup(("flexspline.wal_thickness_mm", "0.4", "wall_thickness_mm"), flexspline__wal_thickness_mm="0.4"),
    # 3000 walls of 0.4 mm
    cup(("flexspline.length_mm = 9000", "to 1200 mm", "up to 3000 times wall_thickness_mm = 0.4", "at least 3"), flexspline__length_mm="9000"),
    cup(("load.torque_Nmm = 500", "did you mean torque_Nm? divide a value in N·mm by 1000"), load__torque_Nmm="500", load__torque_Nm=None),
    cup(("flexspline.wall_thickness_um", "did you mean wall_thickness_mm? divide a value in um by 1000"), flexspline__wall_thickness_um="400.0", flexspline__wall_thickness_mm=None),
    cup(("material.flexspline.youngs_modulus_MPa", "did you mean youngs_modulus_GPa? divide a value in MPa by 1000"), material__flexspline__youngs_modulus_MPa="206000.0", material__flexspline__youngs_modulus_GPa=None),
    cup(("gear.flank_clearance_mm", "did you mean flank_clearance_um? multiply a value in mm by 1000"), gear__flank_clearance_mm="0.004", gear__flank_clearance_um=None),
    # 4.4482216 N times 25.4 mm; 9.80665 N times 10 mm; 4.4482216 N over 645.16 mm² (NIST SP 811, appendix B.8)
    cup(("load.torque_in_lbf", "did you mean torque_Nm? multiply a value in in·lbf by 0.112985"), load__torque_in_lbf="5", load__torque_Nm=None),
    cup(("load.torque_lb_ft", "did you mean torque_Nm? multiply a value in ft·lbf by 1.35582"), load__torque_lb_ft="5", load__torque_Nm=None),
    cup(("load.torque_kgfcm", "did you mean torque_Nm? multiply a value in kgf·cm by 0.0980665"), load__torque_kgfcm="5", load__torque_Nm=None),
    cup(("load.torque_MNm", "did you mean torque_Nm? multiply a value in MN·m by 1000000"), load__torque_MNm="5e-7", load__torque_Nm=None),
    cup(("material.flexspline.fatigue_limit_psi", "did you mean fatigue_limit_MPa? multiply a value in psi by 0.00689476"), material__flexspline__fatigue_limit_psi="7e4", material__flexspline__fatigue_limit_MPa=None),
    cup(("flexspline.length_in", "did you mean length_mm? multiply a value in inches by 25.4"), flexspline__length_in="1.2", flexspline__length_mm=None),
    # a tenth of the ring's module is right; R = 200 mm: 2.9e-3 R³ = 23 200 N·m, a thousandth is 23.2; at R = 20 mm 2320 is the most
    cup(("gear.module_mm = 2.0: must be from", "some 0.2; else no gear of that size has gear.rated_torque_Nm = 20"), gear__module_mm="2.0", gear__rated_torque_Nm="20.0"),
    cup(("gear.module_mm = 0.1: must be from", "and gear.rated_torque_Nm = 100000.0: must be from"), gear__module_mm="0.1", gear__rated_torque_Nm="1e5"),
    cup(("gear.modul_mm", "did you mean module_mm"), gear__modul_mm="0.2", gear__module_mm=None),
    cup(("beering", "unknown key", "bearing"), beering__radial_clearance_um="1"),
    cup(("flexspline.wall_thickness_mm", "missing", "from 0.01 to 0.55 mm"), flexspline__wall_thickness_mm=None),
    cup(("flexspline.wall_thickness_mm", "-0.4", "from 0.01 to 0.55 mm"), flexspline__wall_thickness_mm="-0.4"),
    cup(("flexspline.wall_thickness_mm", "nan", "from 0.01 to 0.55 mm"), flexspline__wall_thickness_mm="nan"),
    cup(("flexspline.length_mm", "inf", "from 9.751 to 1200 mm"), flexspline__length_mm="inf"),
    cup(("flexspline.length_mm", '"30"', "a number", "not text"), flexspline__length_mm='"30"'),
    cup(("flexspline.bolt_count", "6.5", "whole number from 0 to 200"), flexspline__bolt_count="6.5"),
    cup(("flexspline.bolt_count", "-6", "from 0 to 200"), flexspline__bolt_count="-6"),
    cup(("flexspline.bolt_count", "true", "whole number"), flexspline__bolt_count="true"),
    cup(("flexspline.kind", '"bowl"', '"cup" or "hat"'), flexspline__kind='"bowl"'),
    cup(("flexspline.kind", "missing", '"cup" or "hat"'), flexspline__kind=None),
    cup(("flexspline.flange_thickness_mm", "3", "belongs to a hat", "boss_thickness_mm"), flexspline__flange_thickness_mm="3"),
    hat(("flexspline.boss_diameter_mm", "18", "belongs to a cup", "flange_inner_diameter_mm"), flexspline__boss_diameter_mm="18"),
    cup(("material.flexspline.poissons_ratio", "0.5", "0 to 0.49"), material__flexspline__poissons_ratio="0.5"),
    cup(("material.flexspline.youngs_modulus_GPa", "0", "0.001 to 2000 GPa"), material__flexspline__youngs_modulus_GPa="0"),
    cup(("load.torque_Nm", "0.0", "1e-9 to 1000000 N·m"), load__torque_Nm="0.0"),
    cup(("gear.pressure_angle_deg", "90", "5 to 45 deg"), gear__pressure_angle_deg="90"),
    cup(("bearing.bearing_play_model", '"linear"', '"involute" or "small_displacement"'), bearing__bearing_play_model='"linear"'),
    cup(("solver.model", '"magic"', '"axisymmetric", "solid" or "auto"'), solver__model='"magic"'),
    cup(("uncertainty.youngs_modulus_pct", "-1", "0 to 100 %"), uncertainty__youngs_modulus_pct="-1"),
    cup(("flexspline.wall_thickness_mm", "must be a number, not text; write 0.4: numbers are written without unit, the key's name ends",), flexspline__wall_thickness_mm='"0.4 mm"'),
    cup(("flexspline", "not text; write .4e0 without quotation marks",), flexspline__wall_thickness_mm='".4e0"'),
    cup(("flexspline.wall_thickness_mm", "not text"), flexspline__wall_thickness_mm='"thin"'),
    cup(("flexspline.wall_thickness_mm = 0.00001: must",), flexspline__wall_thickness_mm="1e-5"),
    cup(("flexspline.ring_thickness_mm = 0.3: must",), flexspline__ring_thickness_mm="0.30000000000000004"),
    cup(("name", "1 to 200 characters"), name='""'),
    cup(("name", r"\n", "one line"), name=r'"two\nlines"'),
    cup(("name", "1 to 200 characters"), name='"' + "x" * 5000 + '"'),
    cup(("load.torque_Nm", "digits", "1e-9 to 1000000"), load__torque_Nm="0x" + "f" * 5000),
    cup((r"'od\nd'", "unknown key"), **{r'"od\nd"': "1"}),
]  # fmt: skip

GEOMETRY = [
    # Ri − boss r = 10.2; ring start − diaphragm = 21.4
    cup(("flexspline.inner_fillet_mm", "25.0", "0 to 10.2 mm"), flexspline__inner_fillet_mm="25"),
    # Rw − boss r = 10.6; 1 + 0.4 + 0.6 + √(2·0.4·0.6) = 2.69282
    cup(("flexspline.outer_fillet_mm", "11.0", "0 to 2.69281 mm"), flexspline__outer_fillet_mm="11"),
    cup(("flexspline.outer_fillet_mm", "2.7", "0 to 2.69281 mm"), flexspline__outer_fillet_mm="2.7"),
    cup(("flexspline.bolt_circle_diameter_mm", "16.0", "from 10.5001 to 15.4999 mm"), flexspline__bolt_circle_diameter_mm="16"),
    cup(("flexspline.bolt_hole_diameter_mm", "6.0", "from 0.001 to 4.99999 mm"), flexspline__bolt_hole_diameter_mm="6"),
    # π/asin(2.5/13) = 16.2 holes; 13 sin(π/17) = 2.389
    cup(("flexspline.bolt_count", "17", "0 to 16", "to 2.388 mm"), flexspline__bolt_count="17"),
    cup(("flexspline.bolt_circle_diameter_mm", "missing", "bolt_count = 6", "from 10.5001 to 15.4999 mm"), flexspline__bolt_circle_diameter_mm=None),
    cup(("flexspline.bore_diameter_mm", "18.0", "below boss_diameter_mm = 18"), flexspline__bore_diameter_mm="18"),
    cup(("flexspline.boss_diameter_mm", "38.4", "below inner_diameter_mm = 38.4"), flexspline__boss_diameter_mm="38.4"),
    cup(("flexspline.boss_thickness_mm", "0.5", "at least diaphragm_thickness_mm = 0.6"), flexspline__boss_thickness_mm="0.5"),
    cup(("flexspline.boss_thickness_mm", "30.0", "below length_mm = 30"), flexspline__boss_thickness_mm="30"),
    cup(("flexspline.diaphragm_thickness_mm", "30.0", "below length_mm = 30"), flexspline__diaphragm_thickness_mm="30"),
    cup(("flexspline.ring_thickness_mm", "0.3", "0.4 (wall_thickness_mm) or from 0.401 to 30.399 mm"), flexspline__ring_thickness_mm="0.3"),
    # inside 30 − 0.6 = 29.4, outside 30 − 0.15 = 29.85
    cup(("flexspline.ring_width_mm", "31.0", "from 0.001 to 29.4 mm"), flexspline__ring_width_mm="31"),
    cup(("flexspline.ring_offset_mm", "29.5", "below 29.4"), flexspline__ring_offset_mm="29.5"),
    # the ring leaves 30 − 28.9 − 0.6 = 0.5 for the fillet
    cup(("flexspline.inner_fillet_mm", "1.0", "0 to 0.5 mm", "ring"), flexspline__ring_width_mm="28.9"),
    hat(("flexspline.flange_inner_diameter_mm", "58.0", "above", "58.6"), flexspline__flange_inner_diameter_mm="58"),
    hat(("flexspline.flange_outer_diameter_mm", "78.0", "above flange_inner_diameter_mm = 78"), flexspline__flange_outer_diameter_mm="78"),
    hat(("flexspline.flange_thickness_mm", "0.4", "at least diaphragm_thickness_mm = 0.5"), flexspline__flange_thickness_mm="0.4"),
    # flange r − Rw = 9.7
    hat(("flexspline.inner_fillet_mm", "9.8", "0 to 9.7 mm"), flexspline__inner_fillet_mm="9.8"),
    hat(("flexspline.bolt_circle_diameter_mm", "80.0", "from 81.4001 to 92.5999 mm"), flexspline__bolt_circle_diameter_mm="80"),
    # a shoulder to r = 32.3 reaches the flange's r = 31 at z = 16 − 1.3
    hat(("flexspline.flange_thickness_mm", "15.0", "to 14.6999 mm", "z = 14.7"), flexspline__flange_thickness_mm="15",
        flexspline__flange_inner_diameter_mm="62", flexspline__ring_thickness_mm="3.5", flexspline__inner_fillet_mm="0.5"),
    shaft(("shaft.segment[1].inner_diameter_mm", "18.0", "below outer_diameter_mm = 18"), s1__inner_diameter_mm="18"),
    shaft(("shaft.segment[2].outer_diameter_mm", "16.0", "above segment[1].inner_diameter_mm = 17"), s1__inner_diameter_mm="17"),
    shaft(("shaft.fillet_mm", "1.5", "0 to 1 mm", "segment[0] to segment[1]"), fillet_mm="1.5"),
    shaft(("shaft.fillet_mm", "0.5", "0 to 0.3 mm", "length_mm = 0.3"), s1__length_mm="0.3"),
    shaft(("shaft.grip_length_mm", "36.0", "below", "36 mm"), grip_length_mm="36"),
    shaft(("shaft.grip_length_mm", "19.8", "from 0.001 to 19.5, from 20 to 31.5 or from 32 to 35.9999 mm"), grip_length_mm="19.8"),
    shaft(("shaft.bolt_circle_diameter_mm", "missing", "bolt_count = 6"), bolt_count="6", bolt_hole_diameter_mm="3"),
    shaft(("shaft.bolt_circle_diameter_mm", "18.0", "from 9.00001 to 16.9999 mm"), bolt_count="6", bolt_circle_diameter_mm="18", bolt_hole_diameter_mm="3"),
    shaft(("shaft.keyway.depth_mm", "5.0", "from 0.001 to 4.99999 mm"), keyway__depth_mm="5"),
    # chord at r = 8, depth 3: 2√(64 − 25)
    shaft(("shaft.keyway.width_mm", "12.5", "from 0.001 to 12.4899 mm", "chord 12.49 mm"), keyway__width_mm="12.5"),
    shaft(("shaft.keyway.length_mm", "36.0", "below", "36 mm"), keyway__length_mm="36"),
    cup(("gear.teeth_circular_spline", "200", "202"), gear__teeth_circular_spline="200"),
    cup(("gear.teeth_circular_spline", "203", "even", "202, 204"), gear__teeth_circular_spline="203"),
    # 2·0.2·(1 − cos 20°) = 24.12 µm
    cup(("bearing.radial_clearance_um", "24.2", "24.12 µm", "small_displacement"), bearing__radial_clearance_um="24.2"),
    cup(("solver.model", '"axisymmetric"', '"solid" or "auto"', "bolt_count = 6"), solver__model='"axisymmetric"'),
]  # fmt: skip


@pytest.mark.parametrize("bad", ONE_KEY + GEOMETRY, ids=lambda b: b.id)
def test_bad_design_is_refused_in_one_line(bad: Bad, tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(changed_text(bad.example, bad.changes), encoding="utf-8")
    with pytest.raises(DesignError) as caught:
        load_design(path)
    line = str(caught.value)
    assert line.isprintable()  # so it is one line
    assert len(line) < 700
    assert line.startswith(bad.says[0])
    for words in bad.says:
        assert words in line


def test_further_faults_are_counted(tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    three = {"load.torque_Nm": "-1", "gear.module_mm": "0", "flexspline.length_mm": "nan"}
    path.write_text(changed_text("xb1-40", three), encoding="utf-8")
    with pytest.raises(DesignError, match=r"\(and 2 more faults: \S+, \S+\)$"):
        load_design(path)


def test_missing_table_is_named(tmp_path: Path) -> None:
    text = changed_text("xb1-40", {}).replace("[bearing]\n", "")
    path = tmp_path / "bad.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(DesignError) as caught:
        load_design(path)
    assert "radial_clearance_um" in str(caught.value)  # now an unknown key of [gear]
    assert len(caught.value.others) == 1
    assert "; and bearing is missing: give" in str(caught.value)


FILES = {
    "not UTF-8": (b'name = "\xff"', "not UTF-8"),
    "UTF-16": ('name = "x"'.encode("utf-16"), "save it as UTF-8"),
    "UTF-16 without its mark": ('name = "x"'.encode("utf-16-le"), "save it as UTF-8"),
    "latin-1": ('# x\nname = "Zähne"'.encode("latin-1"), r"line 2, byte 13\); save it as UTF-8"),
    "syntax": (b"name = \n[flexspline", "not valid TOML"),
    "duplicate key": (
        b'name = "a"\nname = "b"',
        "not valid TOML: name is given twice, in lines 1 and 2$",
    ),
    "duplicate number": (
        b"[gear]\nx = 1\n[load]\nx = 1\n# x = 2\nx=3\ny = 2\n",
        "x is given twice, in lines 4 and 6$",
    ),
    "duplicate table": (
        b"[load]\nx = 1\n[gear]\nx = 1\n[load]\ny = 2\n",
        r"\[load\] is given twice, in lines 1 and 5$",
    ),
    "full-width point": ('name = "a"\nlength_mm = 38。4\n'.encode(), "write length_mm = 38.4"),
    "full-width equals": ("name ＝ “谐波”\n".encode(), 'write name = "谐波"'),
    "decimal comma": (b'name = "a"\nlength_mm = 38,4  # long\n', "write 38.4 with a point"),
    "a unit behind a number": (
        b'name = "a"\nlength_mm = 38.4 mm  # long\n',
        "write 38.4: numbers are written without unit",
    ),
    "a unit without a space": (
        b'name = "a"\nwidth_um = 3\xc2\xb5m\n',
        "write 3: numbers are written without unit",
    ),
    "no number": (b"name = a b\n", "not valid TOML: [^;]*$"),
    "null byte": (b"name = \x00", "not valid TOML"),
    "deep nesting": (b"x = " + b"[" * 50_000, "TOML|nested"),
    "huge integer": (b"x = " + b"9" * 9000, "TOML"),
    "too large": (b"#" * (LARGEST_TOML_BYTES + 1), "1000001 bytes"),
    "empty": (b"", "the file is empty"),
    "comments alone": (b"# nothing\n", "holds only comments"),
    "not a table": (b"flexspline = 3", "flexspline = 3|name is missing"),
}


@pytest.mark.parametrize(("content", "says"), FILES.values(), ids=FILES)
def test_bad_file_is_refused_in_one_line(content: bytes, says: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    with pytest.raises(DesignError, match=says) as caught:
        load_design(path)
    assert str(caught.value).isprintable()


def test_no_file_directory_and_pipe_are_refused(tmp_path: Path) -> None:
    with pytest.raises(DesignFileError, match="no such file"):
        load_design(tmp_path / "absent.toml")
    with pytest.raises(DesignFileError, match="is a directory"):
        load_design(tmp_path)
    os.mkfifo(tmp_path / "pipe.toml")
    with pytest.raises(DesignFileError, match="is a pipe"):
        load_design(tmp_path / "pipe.toml")
    with pytest.raises(DesignFileError) as caught:
        load_design("nul\x00 and\nnewline.toml")
    assert str(caught.value).isprintable()


def test_a_length_beyond_every_range_is_not_told_how_thick_its_wall_would_have_to_be(
    tmp_path: Path,
) -> None:
    path = tmp_path / "long.toml"
    path.write_text(changed_text("xb1-40", {"flexspline.length_mm": "1e400"}), encoding="utf-8")
    with pytest.raises(DesignError, match=r"from 9\.751 to 1200 mm") as refused:
        load_design(path)
    assert "at least" not in str(refused.value)
