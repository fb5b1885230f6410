"""The command as a user meets it: exit statuses, one-line refusals, JSON, reuse of finished stages."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from math import pi
from pathlib import Path

import in_process
import pytest
from example_files import EXAMPLES

from flexspline.geometry.keys import with_values, without_holes
from flexspline.geometry.load import load_design
from flexspline.geometry.template import design_text
from flexspline.pipeline.temporary_files import MARK
from flexspline.results.file_names import of_export

LIMIT, TOLERANCE = "material.flexspline.fatigue_limit_MPa", "solver.tolerance_pct"
CUP = EXAMPLES / "xb1-40.toml"


def copy_of(source: Path, folder: Path, *changes: tuple[str, str]) -> Path:
    text = source.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "design.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_run_prints_the_contracts_keys_and_nothing_else(finished_cup) -> None:
    result = finished_cup.result
    assert result == json.loads((finished_cup.folder / "result.json").read_text(encoding="utf-8"))
    for key in (
        "K_b_Nm_per_rad", "K_b_lobes_Nm_per_rad", "K_b_lobes_unsupported_Nm_per_rad",
        "K_e_Nm_per_rad", "K_series_Nm_per_rad", "wave_generator_peak_mises_MPa",
        "torque_peak_mises_MPa",
    ):  # fmt: skip
        assert result[key] > 0
    for key in ("K_b", "K_e"):
        low, high = result[f"{key}_bounds_Nm_per_rad"]
        assert low < result[f"{key}_Nm_per_rad"] < high
    terms = result["backlash_arcsec"]
    assert set(terms) == {
        "shaft", "flexspline", "flank_clearance", "bearing_play", "total", "std",
    }  # fmt: skip
    four = (terms[k] for k in ("shaft", "flexspline", "flank_clearance", "bearing_play"))
    assert terms["total"] == pytest.approx(sum(four), rel=1e-12)
    assert {"model", "elements", "dofs", "wall_s", "symmetry"} <= set(result["solver"])
    assert result["solver"]["symmetry"] == "1/12"


def test_series_stiffness_is_near_the_articles(finished_cup) -> None:
    """The example's shaft was chosen for the source's 1.8e4 N·m/rad; within 2 %."""
    assert finished_cup.result["K_series_Nm_per_rad"] == pytest.approx(1.8e4, rel=0.02)


def test_second_run_reuses_everything(finished_cup, tmp_path: Path) -> None:
    first = finished_cup.result
    again = in_process.flexspline("run", CUP, "--out", tmp_path, "--json", folder=tmp_path)
    second = json.loads(again.stdout)
    assert "mesh of" not in again.stderr
    for key, value in first.items():
        if key not in ("solver", "stage_s"):
            assert second[key] == value, key


def test_changed_clearance_does_not_mesh_again(finished_cup, tmp_path: Path) -> None:
    first = finished_cup.result
    design = copy_of(CUP, tmp_path, ("flank_clearance_um = 3.0", "flank_clearance_um = 3.5"))
    done = in_process.flexspline("backlash", design, "--json", folder=tmp_path)
    assert "mesh of" not in done.stderr
    assert "CAD" not in done.stderr
    second = json.loads(done.stdout)
    assert second["K_b_Nm_per_rad"] == first["K_b_Nm_per_rad"]
    assert second["backlash_arcsec"]["flank_clearance"] == pytest.approx(
        first["backlash_arcsec"]["flank_clearance"] * 3.5 / 3, rel=1e-12
    )


def test_damaged_cache_entries_are_discarded_and_said(
    finished_cup, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache, first = finished_cup.cache, finished_cup.result
    broken = tmp_path / "cache"
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(broken))
    shutil.copytree(cache, broken, ignore=shutil.ignore_patterns(f"{MARK}*"))  # others write
    for entry in (broken / "torsion").glob("*.npz"):
        data = bytearray(entry.read_bytes())
        data[len(data) // 2] ^= 0xFF
        entry.write_bytes(bytes(data))
    done = in_process.flexspline(
        "stiffness", CUP, "--out", tmp_path, "--json", folder=tmp_path / "out"
    )
    assert done.status == 0
    assert done.stderr.count("discarded a damaged cache entry") == 2
    # the meshes themselves are whole: the same mesh gives the same K
    K = json.loads(done.stdout)["K_b_Nm_per_rad"]
    assert pytest.approx(first["K_b_Nm_per_rad"], rel=1e-9) == K


@pytest.mark.cad
def test_export_writes_cad_and_fields(finished_cup, tmp_path: Path) -> None:
    words = ("--format", "msh,vtu", "--deck", "--json")
    done = in_process.flexspline("export", CUP, "--out", tmp_path, *words, folder=tmp_path)
    names = [Path(f).name for f in json.loads(done.stdout)["files"]]
    fields = {"flexspline_torque.vtu", "shaft_torque.vtu", "wave_generator.vtu"}
    asked = {"flexspline.msh", "shaft.msh", "flexspline.vtu", "shaft.vtu"}
    decks = {"flexspline_torsion.inp", "shaft_torsion.inp"}
    assert names[:4] == ["flexspline.step", "flexspline.stl", "shaft.step", "shaft.stl"]
    assert set(names[4:]) == fields | asked | decks
    assert set(names) == set(of_export(("msh", "vtu"), deck=True))
    # CAD is written before anything is solved, and each later file before the next is solved
    written = [(tmp_path / name).stat().st_mtime_ns for name in names]
    assert written == sorted(written)
    import pyvista as pv

    grid = pv.read(tmp_path / "wave_generator.vtu")
    # the whole part: the quarter's elements four times
    assert grid.n_cells % 4 == 0
    w0 = 0.2  # m (z2 - z1)/2
    assert abs(grid["displacement_mm"]).max() >= w0 * 0.999
    assert grid["von_mises_MPa"].max() > 0


def test_backlash_with_given_stiffness_needs_no_fea(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(tmp_path / "cache"))
    done = in_process.flexspline(
        "backlash", CUP, "--Kb", 36000, "--Ke", 36000, "--out", tmp_path, "--json", folder=tmp_path
    )
    result = json.loads(done.stdout)
    # 2T/K at 1.8e4 is 11.46 arcsec
    wind_up = result["backlash_arcsec"]["shaft"] + result["backlash_arcsec"]["flexspline"]
    assert wind_up == pytest.approx(11.46, abs=0.005)
    assert "K_b_Nm_per_rad" not in result  # not computed, so absent
    assert result["given"] == {"K_b_Nm_per_rad": 36000.0, "K_e_Nm_per_rad": 36000.0}
    assert not (tmp_path / "cache").exists()


@pytest.mark.parametrize(
    ("words", "needle"),
    [
        (["run", "no-such-file.toml"], "no-such-file.toml"),
        (["backlash", CUP, "--Kb", "-1"], "flexspline: --Kb = -1.0: must"),
        (["backlash", CUP, "--Kb", "nan"], "flexspline: --Kb = nan: must"),
        (["init", "bowl"], "bowl"),
        (["stiffness", CUP, "--out", ""], "names no folder"),
        (["export", CUP, "--format", "dxf"], "msh, med, bdf, inp, vtu, xdmf"),
        (["stiffness", CUP, "--out", CUP], "--out"),
    ],
)
def test_wrong_words_get_one_line_and_status_2(words: list, needle: str, tmp_path: Path) -> None:
    done = in_process.flexspline(*words, folder=tmp_path)  # one line, nothing on stdout
    assert done.status == 2
    assert needle in done.said[0]


def test_wrong_design_writes_nothing(tmp_path: Path) -> None:
    design = copy_of(CUP, tmp_path, ("bore_diameter_mm = 8.0", "bore_diameter_mm = 18.5"))
    done = in_process.flexspline("run", design, folder=tmp_path)
    assert done.status == 2
    assert "flexspline.bore_diameter_mm = 18.5" in done.stderr
    assert list(tmp_path.iterdir()) == [design]


@pytest.mark.parametrize(
    ("number", "status"),
    # of a shorter command by default: test_streams.py
    [pytest.param(signal.SIGINT, 130, marks=pytest.mark.long), (signal.SIGTERM, 143)],
)
def test_a_request_to_stop_leaves_no_half_written_file(
    number: signal.Signals, status: int, tmp_path: Path
) -> None:
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    env = os.environ | {"FLEXSPLINE_CACHE": str(tmp_path / "cache"), "TMPDIR": str(scratch)}
    process = subprocess.Popen(
        [sys.executable, "-m", "flexspline.results.cli", "run", str(CUP), "--out", str(tmp_path / "out")],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=env,
    )  # fmt: skip
    for line in process.stderr:
        if "mesh of the flexspline" in line:
            break
    time.sleep(0.5)
    process.send_signal(number)
    _, rest = process.communicate(timeout=60)
    assert process.returncode == status, rest
    assert "interrupted" in rest
    assert "Traceback" not in rest
    assert not (tmp_path / "out").exists()
    assert not list(tmp_path.rglob("*.part"))
    assert not list(scratch.iterdir())


@pytest.mark.parametrize("kind", ["cup", "hat"])
def test_init_prints_a_design_that_loads(kind: str, tmp_path: Path) -> None:
    text = in_process.flexspline("init", kind, folder=tmp_path).stdout
    assert tomllib.loads(text)["flexspline"]["kind"] == kind
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    done = in_process.flexspline(
        "backlash", path, "--Kb", 3e4, "--Ke", 4e4, "--json", folder=tmp_path
    )
    assert done.status == 0
    assert (tmp_path / "mine.out" / "result.json").exists()


def test_schema_is_json_schema(tmp_path: Path) -> None:
    schema = json.loads(in_process.flexspline("schema", folder=tmp_path).stdout)
    assert {"flexspline", "shaft", "material", "gear", "bearing", "load"} <= set(
        schema["properties"]
    )


def test_a_torque_beyond_the_linear_model_is_said(tmp_path: Path) -> None:
    path = copy_of(CUP, tmp_path, ("torque_Nm = 0.5", "torque_Nm = 5000.0"))
    words = ("backlash", path, "--Kb", 3e4, "--Ke", 4e4, "--out", tmp_path, "--json")
    done = in_process.flexspline(*words, folder=tmp_path)
    assert done.status == 0, done.stderr
    result = json.loads(done.stdout)
    # the twist of one of 200 teeth is no more than this away; the diaphragm's shear comes before
    assert 0 < result["linear_torque_limit_Nm"] < 2 * pi / 200 * 1.72e4
    line = f"load.torque_Nm = 5000 exceeds {result['linear_torque_limit_Nm']:.3g} N·m"
    assert "warning: load.torque_Nm = 5000 exceeds" in done.stderr
    assert any(w.startswith(line) for w in result["warnings"])


def test_a_stress_above_the_stated_limit_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    revolved = without_holes(with_values(load_design(CUP), {LIMIT: 400.0, TOLERANCE: 5.0}))
    path = tmp_path / "design.toml"
    path.write_text(design_text(revolved), encoding="utf-8")
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(tmp_path / "cache"))
    done = in_process.flexspline(
        "stiffness", path, "--out", tmp_path, "--json", folder=tmp_path / "none"
    )
    assert done.status == 0, done.stderr
    result = json.loads(done.stdout)
    assert result["wave_generator_peak_mises_MPa"] > 400
    assert result["wave_generator_peak_at_excluded_border"] is True
    assert result["wave_generator_seat_width_mm"] == 8
    assert result["wave_generator_peak_half_seat_mises_MPa"] > 0
    (line,) = [w for w in result["warnings"] if "Mises" in w]
    assert "is above the fatigue limit of 400" in line
    assert f"({LIMIT})" in line
    assert f"warning: {line}" in done.stderr
