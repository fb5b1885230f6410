"""Documents run: docstring examples, the README's commands, the example designs."""

from __future__ import annotations

import doctest
import importlib
import re
import runpy
from pathlib import Path

import pytest
from example_files import EXAMPLES
from finished_run import finished_run
from opengl import why_no_pictures

from flexspline.geometry.load import load_design
from flexspline.geometry.sanity import warnings
from flexspline.geometry.schema import json_schema
from flexspline.results.file_names import CHARTS, CONVERGENCE, RENDERED

ROOT = Path(__file__).parents[1]
MODULES = sorted(
    "flexspline." + str(p.relative_to(ROOT).with_suffix("")).replace("/", ".")
    for room in ("geometry", "fea", "pipeline", "results")
    for p in (ROOT / room).rglob("*.py")
    if ">>>" in p.read_text(encoding="utf-8")
)
DESIGNS = sorted((EXAMPLES).glob("*.toml"))
MARKS = {
    "keyed-shaft": pytest.mark.cad,  # its keyway is cut by the CAD kernel
    "hat-25": pytest.mark.long,  # two minutes, twelve holes on a free rim
}


@pytest.mark.parametrize("name", MODULES)
def test_docstring_examples(
    name: str, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    monkeypatch.chdir(ROOT)
    if name == "flexspline.pipeline.api":  # its examples ask for the cup's K, stress and slopes
        request.getfixturevalue("finished_cup")
    outcome = doctest.testmod(importlib.import_module(name))
    assert outcome.attempted
    assert not outcome.failed


def test_the_drawings_of_the_rooms_are_the_code_s() -> None:
    drawn = runpy.run_path(str(ROOT / "docs" / "make_architecture.py"))
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    assert drawn["written"](page) == page, "run  python3 docs/make_architecture.py"


def test_readme_opens_with_two_commands_in_order() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```sh\n(.*?)```", text, re.S)
    assert len(blocks) == 2
    for block in blocks:  # Debian refuses to install beside its own packages: an environment first
        assert block.startswith("python3 -m venv .venv && .venv/bin/pip install ")
        assert block.count("\n") == 1
    assert ".venv/bin/flexspline run examples/" in blocks[0]
    assert ".venv/bin/python -m pytest" in blocks[1]
    assert re.search(r"!\[.*\]\((.*?)\)", text).start() < text.index("```sh")
    for target in re.findall(r"\]\(([^)#]+)\)", text):
        assert (ROOT / target).exists(), target


def test_readme_names_every_command() -> None:
    from flexspline.results.cli import app

    text = (ROOT / "README.md").read_text(encoding="utf-8")
    for command in app.registered_commands:
        assert f"`flexspline {command.callback.__name__}" in text


def test_the_contract_names_every_command_and_every_key_of_a_design() -> None:
    from flexspline.results.cli import app

    text = (ROOT / "docs" / "contract.md").read_text(encoding="utf-8")
    for command in app.registered_commands:
        assert f"`flexspline {command.callback.__name__}" in text
    schema = json_schema()
    tables = [schema, *schema["$defs"].values()]
    keys = {key for table in tables for key in table.get("properties", {})}
    assert len(keys) > 60
    named = set(re.findall(r"\w+", text))
    assert keys <= named, keys - named


@pytest.mark.parametrize(
    "path",
    [pytest.param(p, marks=MARKS.get(p.stem, ())) for p in DESIGNS],
    ids=lambda p: p.stem,
)
def test_example_runs(path: Path, suite_folder: Path, suite_cache: Path) -> None:
    """The whole main job on every example; they are the size of real work."""
    run = finished_run(path.stem, suite_folder, suite_cache)
    result, design = run.result, load_design(path)
    assert not warnings(design)
    low, high = result["K_b_bounds_Nm_per_rad"]
    assert low <= result["K_b_Nm_per_rad"] <= high
    assert (high - low) / 2 <= design.solver.tolerance_pct / 100 * result["K_b_Nm_per_rad"] * 1.001
    # the rim supported at the lobes is softer than the ring turned whole, and stiffer than free
    assert (
        result["K_b_Nm_per_rad"]
        > result["K_b_lobes_Nm_per_rad"]
        > result["K_b_lobes_unsupported_Nm_per_rad"]
    )
    assert (run.folder / "report.pdf").stat().st_size > 10_000
    missing = set(result.get("pictures_missing", {}))
    drawn = {p.stem for p in run.folder.glob("*.png")}
    listed = {*RENDERED, *CHARTS}
    assert drawn | missing | {CONVERGENCE} == listed, "results/file_names.py lists all pictures"
    assert not drawn & missing
    assert not missing or why_no_pictures()
