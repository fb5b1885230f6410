"""Documents run: docstring examples, the README's commands, the example designs."""

from __future__ import annotations

import ast
import doctest
import importlib
import json
import re
import runpy
from collections.abc import Iterator
from pathlib import Path

import pytest
from example_files import EXAMPLES
from finished_run import FinishedRun, finished_run
from in_process import flexspline
from opengl import why_no_pictures

from flexspline.geometry.load import load_design
from flexspline.geometry.sanity import warnings
from flexspline.geometry.schema import json_schema
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.specimens.cause_ids import GEOMETRY, LOAD_ZONE, YOUNGS_MODULUS
from flexspline.results.file_names import CHARTS, RENDERED

ROOT = Path(__file__).parents[1]
MODULES = sorted(
    "flexspline." + str(p.relative_to(ROOT).with_suffix("")).replace("/", ".")
    for room in ("geometry", "fea", "pipeline", "results")
    for p in (ROOT / room).rglob("*.py")
    if ">>>" in p.read_text(encoding="utf-8")
)
CONTRACT = ROOT / "docs" / "contract.md"
WRITERS = ("records", "gear", "diagnosis/record", "diagnosis/data_used", "diagnosis/gear_inputs",
           "diagnosis/reading", "study/sensitivity")  # fmt: skip
"""In results/: what writes result.json, gear.json, diagnosis.json and sensitivity.json."""
DESIGNS = sorted((EXAMPLES).glob("*.toml"))
MARKS = {
    # its keyway is cut by the CAD kernel; by default: test_unfilleted_shaft.py
    "keyed-shaft": (pytest.mark.cad, pytest.mark.long),
    "hat-25": pytest.mark.long,  # two minutes, twelve holes on a free rim
}


API = "flexspline.pipeline.api"
STUDIES = (f"{API}.sensitivity", f"{API}.study")
"""Of functions that solve many designs; by default: tests/pipeline/study/ and tests/results/study/."""


def examples(module: str) -> dict[str, doctest.DocTest]:
    """By the place of their docstring."""
    found = doctest.DocTestFinder().find(importlib.import_module(module), module)
    return {one.name: one for one in found if one.examples}


@pytest.mark.parametrize("name", MODULES)
def test_docstring_examples(
    name: str, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    monkeypatch.chdir(ROOT)
    if name == API:  # its examples ask for the cup's K and stress
        request.getfixturevalue("finished_cup")
    shown = {place: one for place, one in examples(name).items() if place not in STUDIES}
    assert shown
    for one in shown.values():
        assert not doctest.DocTestRunner().run(one).failed


@pytest.mark.long
@pytest.mark.parametrize("place", STUDIES)
def test_docstring_examples_of_studies(
    place: str, finished_cup: FinishedRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    assert not doctest.DocTestRunner().run(examples(API)[place]).failed


def test_the_drawings_of_the_rooms_are_the_code_s() -> None:
    drawn = runpy.run_path(str(ROOT / "docs" / "make_architecture.py"))
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    assert drawn["written"](page) == page, "run  python3 docs/make_architecture.py"


def test_the_contract_s_tables_of_figures_are_the_program_s() -> None:
    made = runpy.run_path(str(ROOT / "docs" / "make_record_keys.py"))
    page = CONTRACT.read_text(encoding="utf-8")
    assert made["written"](page) == page, "run  python3 docs/make_record_keys.py"


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

    text = CONTRACT.read_text(encoding="utf-8")
    for command in app.registered_commands:
        assert f"`flexspline {command.callback.__name__}" in text
    schema = json_schema()
    tables = [schema, *schema["$defs"].values()]
    keys = {key for table in tables for key in table.get("properties", {})}
    assert len(keys) > 60
    named = set(re.findall(r"\w+", text))
    assert keys <= named, keys - named


def test_the_contract_names_every_cause() -> None:
    text = CONTRACT.read_text(encoding="utf-8")
    for name in (*known_causes(), YOUNGS_MODULUS, LOAD_ZONE, GEOMETRY):
        assert f"\n| `{name}" in text, name


def listed_keys(record: str) -> list[str]:
    """The keys of a record as section 5 of the contract lists them, nested ones joined by dots."""
    section = CONTRACT.read_text(encoding="utf-8").split(f"### Keys of `{record}`\n")[1]
    rows = re.findall(r"^\|([^|]*)\|", section.split("\n### ")[0], re.M)
    return [key.replace("[]", "") for row in rows for key in re.findall(r"`(.+?)`", row)]


def unlisted(found: dict, record: str) -> list[str]:
    """Keys of a record that its tables do not list; `<…>` there stands for any name."""
    patterns = [".+".join(map(re.escape, re.split(r"<.*?>", key))) for key in listed_keys(record)]
    known = re.compile("|".join(patterns))
    return [key for key in flat(found) if not known.fullmatch(key)]


def flat(found: dict, prefix: str = "") -> Iterator[str]:
    """An empty list names no key: what would stand in it is not known."""
    for key, value in found.items():
        if isinstance(value, dict):
            yield from flat(value, f"{prefix}{key}.")
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for one in value:
                yield from flat(one, f"{prefix}{key}.")
        elif value != []:
            yield prefix + key


@pytest.mark.usefixtures("no_diagnosis_drawn")  # no record has a key of them
def test_the_contract_lists_every_key_of_an_example_s_records(
    finished_cup: FinishedRun, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a run, of the gear alone, of a sweep against sum and gear, and of end points."""
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(finished_cup.cache))
    K = ("--Kb", "31312", "--Ke", "43275")
    sweep, points = (
        EXAMPLES / "measured" / f"{name}.csv" for name in ("xb1-40-sweep", "size-40-end-points")
    )
    run = {k: v for k, v in finished_cup.result.items() if k != "gear"}
    assert not unlisted(run, "result.json")
    assert not unlisted(finished_cup.result["gear"], "gear.json")
    for record, words in (
        ("gear.json", ("gear", finished_cup.design)),
        ("diagnosis.json", ("diagnose", finished_cup.design, sweep, *K)),
        ("diagnosis.json", ("diagnose", finished_cup.design, sweep, "--against", "gear")),
        ("diagnosis.json", ("diagnose", finished_cup.design, points, *K)),
    ):
        ended = flexspline(*words, "--out", tmp_path / "out", "--json", folder=tmp_path)
        assert ended.status == 0, ended.stderr
        assert not unlisted(json.loads(ended.stdout), record), words


@pytest.mark.parametrize("writer", WRITERS)
def test_the_contract_lists_every_key_that_is_written_by_name(writer: str) -> None:
    """Those too that no example has, as `units` of a cause that not all units show."""
    tree = ast.parse((ROOT / "results" / f"{writer}.py").read_text(encoding="utf-8"))
    nodes = list(ast.walk(tree))
    keys = [k for node in nodes if isinstance(node, ast.Dict) for k in node.keys]
    keys += [
        n.slice for n in nodes if isinstance(n, ast.Subscript) and isinstance(n.ctx, ast.Store)
    ]
    names = {k.value for k in keys if isinstance(k, ast.Constant) and isinstance(k.value, str)}
    records = ("result.json", "gear.json", "diagnosis.json", "sensitivity.json")
    listed = {key for record in records for key in listed_keys(record)}
    known = {part for key in listed for part in key.split(".")}
    assert names - NOT_KEYS <= known, names - known


NOT_KEYS = {"flexspline", "shaft", ".", ","}
"""Other names in those files: of parts, of decimal marks."""


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
    assert drawn | missing | {"convergence"} == listed, "results/file_names.py lists all pictures"
    assert not drawn & missing
    assert not missing or why_no_pictures()
