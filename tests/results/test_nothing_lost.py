"""What fails costs its own figure only: the others are given, and the reason is said everywhere."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import pytest
from example_files import EXAMPLES
from page_text import letters, pdf_letters, read_page
from typer.testing import CliRunner
from written_report import write_report

from flexspline.geometry.errors import ComputationError
from flexspline.geometry.load import load_design
from flexspline.pipeline import analysis
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress
from flexspline.results.cli import app
from flexspline.results.pictures import RunPictures
from flexspline.results.report import build
from flexspline.results.report.page import page_of
from flexspline.results.report.sections import run_document
from flexspline.results.warned import all_warnings

EXAMPLE = EXAMPLES / "keyed-shaft.toml"
WHY = "the contact on the seat did not settle in 60 rounds"
BOTH = ("K_b_Nm_per_rad", "K_e_Nm_per_rad")
LOBES = ("K_b_lobes_Nm_per_rad", "K_b_lobes_contact_Nm_per_rad", "K_b_lobes_unsupported_Nm_per_rad")
PEAK = "wave_generator_peak_mises_MPa"


@pytest.fixture
def revolved(tmp_path: Path) -> Path:
    """The hole-free cup on a shaft without its keyway, to 5 %: everything on the meridian."""
    text = EXAMPLE.read_text(encoding="utf-8")
    before, _, rest = text.partition("[shaft.keyway]")
    _, _, after = rest.partition("[material.flexspline]")
    path = tmp_path / "revolved.toml"
    path.write_text(
        f"{before}[material.flexspline]{after}\n[solver]\ntolerance_pct = 5.0\n", encoding="utf-8"
    )
    return path


def fail(*given: object, **named: object) -> None:
    raise ComputationError(WHY)


@dataclass(frozen=True)
class Answer:
    status: int
    record: dict
    told: list[str]

    def mentions(self, name: str) -> bool:
        """The reason, beside a figure's long name, once in `warnings` and once on stderr."""
        line = f"{name}: not computed, {WHY}"
        return self.record["warnings"].count(line) == 1 == self.told.count(f"warning: {line}")


def asked(command: str, design: Path) -> Answer:
    done = CliRunner().invoke(
        app, [command, str(design), "--json"],
        env={"FLEXSPLINE_CACHE": str(design.parent / "cache")}, catch_exceptions=False,
    )  # fmt: skip
    record = json.loads(done.stdout)
    kept = (design.parent / "revolved.out" / "result.json").read_text(encoding="utf-8")
    assert json.loads(kept) == record
    return Answer(done.exit_code, record, done.stderr.splitlines())


@pytest.mark.parametrize(
    ("broken", "lost", "name"),
    [
        ("load_cases.contact_stiffness", LOBES[1],
         "Flexspline stiffness, torque at the two lobes, rim may lift off"),
        ("ellipse_peak.ellipse_stress", PEAK, "Peak von Mises stress, wave-generator ellipse"),
    ],
)  # fmt: skip
def test_a_load_case_that_fails_costs_its_own_figure(broken, lost, name, revolved, monkeypatch):
    monkeypatch.setattr(f"flexspline.pipeline.{broken}", fail)
    answer = asked("stiffness", revolved)
    assert answer.status == 0
    assert {k for k in (*BOTH, *LOBES, PEAK) if k not in answer.record} == {lost}
    assert answer.mentions(name)


@pytest.mark.parametrize(
    ("command", "others"),
    [
        ("stiffness", (*LOBES, PEAK)),
        ("backlash", ()),
        pytest.param("run", (*LOBES, PEAK), marks=pytest.mark.long),  # both, and the pictures
    ],
)
def test_without_k_b_the_rest_is_kept_and_the_status_is_1(command, others, revolved, monkeypatch):
    from flexspline.pipeline import part_stiffness

    solve = part_stiffness.torsional_stiffness
    monkeypatch.setattr(
        part_stiffness, "torsional_stiffness",
        lambda outline, material, driven, *rest: (
            fail() if driven == "mesh" else solve(outline, material, driven, *rest)
        ),
    )  # fmt: skip
    name = "Flexspline stiffness, uniform torque on the ring"
    answer = asked(command, revolved)
    assert answer.status == 1
    assert answer.mentions(name)
    assert answer.told[-1].endswith(f"K_b was not found: {WHY}")
    assert {"K_e_Nm_per_rad", *others} <= set(answer.record)
    assert not {"K_b_Nm_per_rad", "K_series_Nm_per_rad", "backlash_arcsec"} & set(answer.record)


def test_a_missed_tolerance_is_said_with_its_bounds(revolved, monkeypatch):
    for module in ("torsion", "lobes"):
        monkeypatch.setattr(f"flexspline.fea.axisymmetric.{module}.MOST_TRIANGLES", 10)
    text = revolved.read_text(encoding="utf-8")
    revolved.write_text(text.replace("pct = 5.0", "pct = 1.0"), encoding="utf-8")
    answer = asked("stiffness", revolved)
    assert answer.status == 0
    low, high = answer.record["K_b_bounds_Nm_per_rad"]
    half = 50 * (high - low) / answer.record["K_b_Nm_per_rad"]
    assert half > 1.0
    said = f"K_b is known to ± {half:.2g} %, wider than the requested ± 1 %"
    mine = [line for line in answer.record["warnings"] if line.startswith(said)]
    assert len(mine) == 1
    assert "a mesh of more than 10 elements is not refined" in mine[0]
    assert f"warning: {mine[0]}" in answer.told
    assert answer.record["K_b_bounds_kind"] == "guaranteed"  # wide, and true all the same


def test_a_report_is_made_of_what_there_is(revolved, tmp_path, monkeypatch):
    """Neither fields nor contact: the report says so, and has the rest."""
    for broken in ("torque_field", "ellipse_field"):
        monkeypatch.setattr(analysis, broken, fail)
    monkeypatch.setattr("flexspline.pipeline.load_cases.contact_stiffness", fail)
    cache = Cache(tmp_path / "cache")
    result = analysis.run(AnalysisContext(load_design(revolved), cache, Progress()))
    assert not result.fields
    lines = [line for line in all_warnings(result) if line.endswith(f"not computed, {WHY}")]
    assert len(lines) == 4  # two peaks under torque, the ellipse, the contact
    content = build.report_content(result, RunPictures({}), None, ())
    write_report(tmp_path / "r.pdf", content)
    page, *_ = read_page(page_of(run_document(content), {}, {}).decode())
    for said in (pdf_letters(tmp_path / "r.pdf"), letters(" ".join(page))):
        for line in lines:
            assert letters(line) in said
        assert letters("Read the 4 warnings in") in said


def test_the_same_failure_is_not_waited_for_twice(tmp_path):
    calls = []

    def make() -> float:
        calls.append(1)
        raise ComputationError(WHY)

    cache = Cache(tmp_path)
    for _ in range(3):
        with pytest.raises(ComputationError, match=WHY):
            cache.get("mesh", {"edge_mm": 1.0}, make)
    assert len(calls) == 1
    assert cache.get("mesh", {"edge_mm": 2.0}, lambda: 3.0) == (3.0, False)
