"""`flexspline study` and `flexspline sensitivity` as a user calls them."""

import csv
import json
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from example_files import EXAMPLES
from opengl import why_no_pictures
from pypdf import PdfReader
from typer.testing import CliRunner

from flexspline.pipeline.study import stiffness_slopes
from flexspline.results.cli import app
from flexspline.results.file_names import STUDY as STUDY_FILES
from flexspline.results.study import answer

DESIGN = EXAMPLES / "xb1-40.toml"
STUDY = """
design = "{design}"
[vary]
"flexspline.wall_thickness_mm" = {{ min = 0.36, max = 0.70, steps = 2 }}
"flexspline.diaphragm_thickness_mm" = {{ values = [0.5, 0.7] }}
[objective]
"K_b_Nm_per_rad" = "maximize"
"flexspline_mass_g" = "minimize"
[constraint]
"backlash_arcsec.total" = {{ max = 95.0 }}
[run]
method = "grid"
workers = {workers}
"""


def written(folder: Path, workers: int = 1, text: str = STUDY) -> Path:
    """Of the example without holes, whose best design's field takes a second; one with holes:
    `test_without_opengl.py`."""
    design = folder / '#emph[x] "gear.toml'.replace('"', "")
    whole = DESIGN.read_text().replace("bolt_count = 6", "bolt_count = 0")
    design.write_text(whole.replace("XB1-40 cup", "#panic(1) $x$ cup"))
    path = folder / "walls.toml"
    path.write_text(text.format(design=design.name, workers=workers))
    return path


def rows_of(folder: Path) -> list[dict[str, str]]:
    with open(folder / "study.csv", encoding="utf-8", newline="") as file:
        return [{k: v for k, v in r.items() if k != "wall_s"} for r in csv.DictReader(file)]


@pytest.fixture
def nothing_drawn(monkeypatch: pytest.MonkeyPatch) -> Callable[[], None]:
    """From its call on, studies end with their tables."""

    def begin() -> None:
        for name in ("write_figures", "write_study_reports"):
            monkeypatch.setattr(answer, name, lambda *_: [])
        monkeypatch.setattr(answer, "best_field", lambda *_: None)

    return begin


def test_a_grid_and_its_resumption(tmp_path: Path, nothing_drawn: Callable[[], None]) -> None:
    one = CliRunner().invoke(
        app, ["study", str(written(tmp_path)), "--out", str(tmp_path / "1"), "--json"]
    )
    assert one.exit_code == 0, one.output
    said = json.loads(one.stdout)
    assert said["evaluations"] == 4
    assert said["failed"] == 2  # a wall of 0.7 mm is thicker than the ring
    rows = rows_of(tmp_path / "1")
    assert sum("ring_thickness_mm" in r["reason"] for r in rows) == 2
    for name in said["files"]:
        assert Path(name).stat().st_size > 0
    assert {p.name for p in (tmp_path / "1").iterdir()} <= set(STUDY_FILES)
    assert "best.toml" in {Path(name).name for name in said["files"]}
    text = "".join(p.extract_text() for p in PdfReader(tmp_path / "1" / "report.pdf").pages)
    assert "2 of 4 designs were built and solved" in text
    assert "#panic(1) $x$ cup" in text  # as its letters
    drawn = not why_no_pictures()
    assert ("best_stress.png" in {Path(name).name for name in said["files"]}) is drawn
    assert f"Design {said['best'][0]['design']} on the wave generator" in text
    assert ("3-D view" in (tmp_path / "1" / "report.html").read_text()) is drawn

    nothing_drawn()
    again = CliRunner().invoke(
        app, ["study", str(written(tmp_path)), "--out", str(tmp_path / "1"), "--json"]
    )
    assert again.exit_code == 0
    assert "4 designs are already finished" in again.stderr
    assert rows_of(tmp_path / "1") == rows


@pytest.mark.long  # by default: tests/pipeline/study/test_cluster.py, test_resume.py
def test_a_grid_on_two_processes(tmp_path: Path, nothing_drawn: Callable[[], None]) -> None:
    nothing_drawn()
    one = CliRunner().invoke(
        app, ["study", str(written(tmp_path)), "--out", str(tmp_path / "1"), "--json"]
    )
    assert one.exit_code == 0
    two = CliRunner().invoke(
        app, ["study", str(written(tmp_path, workers=2)), "--out", str(tmp_path / "2"), "--json"]
    )
    assert two.exit_code == 0
    assert rows_of(tmp_path / "2") == rows_of(tmp_path / "1")


def test_parquet_has_the_same_columns_with_types(tmp_path: Path) -> None:
    from pyarrow import parquet

    from flexspline.pipeline.study.claims import Row
    from flexspline.pipeline.study.evaluate import Outcome
    from flexspline.pipeline.study.load import load_study
    from flexspline.pipeline.study.result import StudyResult
    from flexspline.results.study.tables import table_of, write_csv, write_parquet

    values = {"flexspline.wall_thickness_mm": 0.4, "flexspline.diaphragm_thickness_mm": 0.5}
    figures = {"K_b_Nm_per_rad": 3.0, "flexspline_mass_g": 1.0, "backlash_arcsec.total": 90.0}
    rows = (Row(0, values, Outcome(figures)), Row(1, values, Outcome(faults=("too thin, it is",))))
    table = table_of(StudyResult(load_study(written(tmp_path)), rows))
    write_csv(tmp_path / "study.csv", table)
    write_parquet(tmp_path / "study.parquet", table)
    read = parquet.read_table(tmp_path / "study.parquet").to_pydict()
    assert read == table
    assert read["K_b_Nm_per_rad"] == [3.0, None]
    lines = rows_of(tmp_path)
    assert [r["reason"] for r in lines] == ["", "too thin, it is"]
    assert [r["K_b_Nm_per_rad"] for r in lines] == ["3.0", ""]


def test_without_pyarrow_the_table_is_csv_alone_and_a_line_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, nothing_drawn: Callable[[], None]
) -> None:
    nothing_drawn()
    monkeypatch.setitem(sys.modules, "pyarrow", None)  # an import of it fails
    out = tmp_path / "out"
    one_wall = STUDY.replace("{{ min = 0.36, max = 0.70, steps = 2 }}", "{{ values = [0.4] }}")
    study = written(tmp_path, text=one_wall)
    done = CliRunner().invoke(app, ["study", str(study), "--out", str(out), "--json"])
    assert done.exit_code == 0
    files = {Path(name).name for name in json.loads(done.stdout)["files"]}
    assert "study.csv" in files
    assert "study.parquet" not in files
    assert not (out / "study.parquet").exists()
    (line,) = [line for line in done.stderr.splitlines() if "study.parquet" in line]
    assert "flexspline[parquet]" in line
    assert len(rows_of(out)) == 2


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("workers = {workers}", 'scheduler = "tcp://127.0.0.1:1"', "no Dask scheduler answers"),
        ('method = "grid"', 'method = "magic"', "run.method"),
        ("min = 0.36", "min = 0.9", "below max"),
        ('"K_b_Nm_per_rad" =', '"K_b_Nm_per_radian" =', "did you mean K_b_Nm_per_rad?"),
    ],
)
def test_a_wrong_study_leaves_nothing(
    old: str, new: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flexspline.pipeline.study.cluster.CONNECT_S", 1.0)
    out = tmp_path / "out"
    done = CliRunner().invoke(
        app, ["study", str(written(tmp_path, text=STUDY.replace(old, new))), "--out", str(out)]
    )
    assert done.exit_code == 2
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert not out.exists()


def slopes_said(folder: Path, design: Path = DESIGN) -> list[dict]:
    """What `sensitivity` of a design prints and stores."""
    done = CliRunner().invoke(
        app, ["sensitivity", str(design), "--out", str(folder), "--json"]
    )  # fmt: skip
    assert done.exit_code == 0
    said = json.loads(done.stdout)
    assert said == json.loads((folder / "sensitivity.json").read_text())
    slopes = said["sensitivity"]
    assert {"key", "value_mm", "figure", "adjoint_Nm_per_rad_per_mm"} <= set(slopes[0])
    assert [s for s in slopes if not s.get("agree")] == []
    return slopes


def test_sensitivity_prints_its_table_as_json(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a dimension of each part."""
    keys = {"flexspline.wall_thickness_mm", "shaft.segment[1].outer_diameter_mm"}
    every = stiffness_slopes.lengths
    monkeypatch.setattr(
        stiffness_slopes,
        "lengths",
        lambda part: {k: v for k, v in every(part).items() if k in keys},
    )
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(tmp_path / "cache"))
    written(tmp_path)
    assert {s["key"] for s in slopes_said(tmp_path, next(tmp_path.glob("*gear.toml")))} == keys


@pytest.mark.long
def test_sensitivities_of_all_dimensions_obey_scaling(tmp_path: Path) -> None:
    slopes = slopes_said(tmp_path)
    for figure in ("K_b_Nm_per_rad", "K_e_Nm_per_rad"):  # Euler, as in test_sensitivity.py
        own = [s["pct_per_pct"] for s in slopes if s["figure"] == figure]
        assert sum(own) == pytest.approx(3.0, abs=0.01)
