"""On a machine without OpenGL everything but the pictures of parts comes, and the reports say so."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from example_files import EXAMPLES
from finished_run import FinishedRun
from opengl import machine_without
from page_text import letters, pdf_letters, read_page
from typer.testing import CliRunner

from flexspline.results.cli import app
from flexspline.results.file_names import CHARTS, RENDERED

CUP = EXAMPLES / "xb1-40.toml"
SAID = "apt-get install libegl1 libgl1"
Run = subprocess.CompletedProcess[str]


def flexspline(cache: Path, *words: object, without: Path | None = None) -> Run:
    """The command; `without`: a folder to hide OpenGL with."""
    scratch = cache.with_name("scratch")  # nobody else's leftovers are cleared, and said, here
    scratch.mkdir(exist_ok=True)
    env = os.environ | {"FLEXSPLINE_CACHE": str(cache), "TMPDIR": str(scratch)}
    if without:
        without.mkdir()
        env |= machine_without(without)
        env.pop("DISPLAY", None)
    return subprocess.run(
        [sys.executable, "-m", "flexspline.results.cli", *map(str, words)],
        capture_output=True, text=True, check=False, env=env,
    )  # fmt: skip


@pytest.fixture(scope="module")
def bare(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, Run]:
    """A run where no OpenGL loads, of the example without holes, quickly: design, folder, how it ended."""
    place = tmp_path_factory.mktemp("bare")
    design, folder = place / "cup.toml", place / "cup.out"
    text = CUP.read_text(encoding="utf-8").replace("bolt_count = 6", "bolt_count = 0")
    design.write_text(text + "\n[solver]\ntolerance_pct = 5.0\n", encoding="utf-8")
    folder.mkdir()
    (folder / "wave_generator.png").write_bytes(b"an earlier design's")
    done = flexspline(place / "cache", "run", design, "--json", without=place / "libraries")
    return design, folder, done


def test_the_answer_charts_and_reports_come_with_status_0(bare) -> None:
    _, folder, done = bare
    assert done.returncode == 0, done.stderr
    result = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    assert result == json.loads(done.stdout)
    assert result["K_b_Nm_per_rad"] > 0
    assert set(result["pictures_missing"]) == set(RENDERED)
    assert {p.stem for p in folder.glob("*.png")} == set(CHARTS)  # nor an earlier run's pictures
    assert {"report.pdf", "report.html"} <= {p.name for p in folder.iterdir()}


def test_one_warning_names_the_pictures_and_the_package(bare) -> None:
    said = bare[2].stderr.splitlines()
    (warning,) = [line for line in said if "warning" in line]
    assert SAID in warning
    assert all(name in warning for name in RENDERED)
    others = [line for line in said if not line.startswith(("[", "warning: ", "note: "))]
    assert not others  # VTK's own words are not there


def test_both_reports_say_what_is_missing_and_why(bare) -> None:
    folder = bare[1]
    page = read_page((folder / "report.html").read_text(encoding="utf-8"))[0]
    for text in (pdf_letters(folder / "report.pdf"), page):
        assert letters(SAID) in text
        assert text.count(letters("Not drawn:")) == 3  # under torque, on the ellipse, meshes
        assert letters("Mesh of the output shaft") in text
        assert letters("Flexspline on the wave generator: the ellipse") in text


@pytest.mark.long  # of a chart by default: test_run_drawings.py
@pytest.mark.opengl
def test_a_missing_picture_is_not_remembered(bare, tmp_path: Path, monkeypatch) -> None:
    """The reports have their own tests."""
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(bare[0].parent / "cache"))
    monkeypatch.setattr("flexspline.results.run.write_run_reports", lambda *_: None)
    again = CliRunner().invoke(app, ["run", str(bare[0]), "--json", "--out", str(tmp_path)])
    assert again.exit_code == 0, again.stderr
    assert "mesh of" not in again.stderr
    assert "pictures_missing" not in json.loads(again.stdout)
    assert {p.stem for p in tmp_path.glob("*.png")} == {*RENDERED, *CHARTS}


def test_the_answer_is_on_disk_before_anything_is_drawn(bare, tmp_path, monkeypatch) -> None:
    seen = []

    def stop(*_: object) -> None:
        seen.append(json.loads((tmp_path / "result.json").read_text(encoding="utf-8")))
        raise KeyboardInterrupt

    monkeypatch.setenv("FLEXSPLINE_CACHE", str(bare[0].parent / "cache"))
    monkeypatch.setattr("flexspline.results.run.write_pictures", stop)
    done = CliRunner().invoke(app, ["run", str(bare[0]), "--out", str(tmp_path)])
    assert done.exit_code == 130
    answer = json.loads(bare[2].stdout)
    for key in ("K_b_Nm_per_rad", "K_series_Nm_per_rad", "wave_generator_peak_mises_MPa"):
        assert seen[0][key] == answer[key]
    assert seen[0]["backlash_arcsec"] == answer["backlash_arcsec"]


def test_what_needs_the_cad_kernel_is_one_line_that_names_the_package(tmp_path: Path) -> None:
    """The kernel is linked with libGL."""
    done = flexspline(
        tmp_path / "cache", "export", CUP, "--out", tmp_path / "out", without=tmp_path / "none"
    )
    assert done.returncode == 1
    said = [line for line in done.stderr.splitlines() if not line.startswith("[")]
    assert len(said) == 1
    assert "apt-get install libgl1" in said[0]
    assert not (tmp_path / "out").exists()


@pytest.mark.long
def test_a_study_keeps_its_table_and_says_what_is_missing(
    finished_cup: FinishedRun, tmp_path: Path
) -> None:
    """The lightest is the example itself: the suite's cache holds its field, and nobody's picture of it."""
    study = tmp_path / "walls.toml"
    study.write_text(
        f'design = "{CUP}"\n[vary]\n"flexspline.wall_thickness_mm" = {{ values = [0.4, 0.45] }}\n'
        '[objective]\n"flexspline_mass_g" = "minimize"\n[run]\nmethod = "grid"\nworkers = 1\n',
        encoding="utf-8",
    )
    folder = tmp_path / "out"
    done = flexspline(
        finished_cup.cache, "study", study, "--out", folder, without=tmp_path / "libraries"
    )
    assert done.returncode == 0, done.stderr
    assert (folder / "study.csv").stat().st_size > 0
    assert not (folder / "best_stress.png").exists()
    (warning,) = [line for line in done.stderr.splitlines() if "warning" in line]
    assert SAID in warning
    page = read_page((folder / "report.html").read_text(encoding="utf-8"))[0]
    for text in (pdf_letters(folder / "report.pdf"), page):
        assert letters(SAID) in text
        assert letters("Design 0 on the wave generator.") in text
