"""The house: imports go one way, heavy libraries stay in their rooms and load late."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path

import pytest
from source_tree import parsed

ROOT = Path(__file__).parents[1]
ROOMS = ("geometry", "fea", "pipeline", "results")
ONLY_IN = {
    "cadquery": "geometry", "OCP": "geometry", "trimesh": "geometry",
    "pytetwild": "fea", "skfem": "fea", "pypardiso": "fea",
    "optuna": "pipeline", "dask": "pipeline", "distributed": "pipeline",
    "pyvista": "results", "matplotlib": "results", "typst": "results", "typer": "results",
    "aiohttp": "results", "meshio": "results", "h5py": "results", "pyarrow": "results",
}  # fmt: skip
FILES = sorted(p for room in ROOMS for p in (ROOT / room).rglob("*.py"))
TYPE_NAME = re.compile("_?[A-Z]+[a-z]")
"""CamelCase; a type variable is a capital or two."""
TINY = 1e-9
"""Below every tolerance of the pipeline in any unit: a number that is no larger stands for 0."""


def room_of(module: str) -> str:
    return module.removeprefix("flexspline.").partition(".")[0]


def imports(path: Path) -> Iterator[str]:
    """The room, or else the top-level package, of every import in a file, for types only too."""
    for node in ast.walk(parsed(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield room_of(alias.name)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield room_of(node.module)


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_imports_keep_to_the_house(path: Path) -> None:
    room = path.relative_to(ROOT).parts[0]
    for name in imports(path):
        if name in ROOMS:
            assert ROOMS.index(name) <= ROOMS.index(room), f"{room} must not know {name}"
        assert ONLY_IN.get(name, room) == room, f"{name} belongs in {ONLY_IN.get(name)}"
        assert name != "tests"


SWEEP = ROOT / "pipeline" / "diagnosis" / "sweep"
STEPS = (
    "nuisance",
    "evidence",
    "crossing",
    "identification",
    "race",
    "magnitudes",
    "residual",
    "rig_faults",
)
"""Folders of a sweep's diagnosis: each imports from those before it, as its `__init__.py` says."""


@pytest.mark.parametrize("folder", STEPS)
def test_steps_of_a_sweep_import_one_way(folder: str) -> None:
    later = STEPS[STEPS.index(folder) + 1 :]
    for path in (SWEEP / folder).glob("*.py"):
        text = path.read_text(encoding="utf-8")
        seen = set(re.findall(r"from flexspline\.pipeline\.diagnosis\.sweep\.(\w+)", text))
        assert not seen & set(later), f"{path.name} must not know {seen & set(later)}"


def test_every_folder_of_a_sweep_has_its_place() -> None:
    assert {p.parent.name for p in SWEEP.glob("*/__init__.py")} == set(STEPS)


def test_the_check_sees_a_backward_import(tmp_path: Path) -> None:
    bad = tmp_path / "bad.py"
    bad.write_text("def f():\n    from flexspline.results.cli import main\n    import cadquery\n")
    assert list(imports(bad)) == ["results", "cadquery"]


def type_names(text: str) -> Iterator[str]:
    """Classes of a file, and the names that it gives to types at its top: aliases, NewTypes, `type X = …`."""
    tree = parsed(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            yield node.name
    for node in tree.body:
        named: list[ast.expr] = []
        if isinstance(node, ast.Assign):
            named = node.targets
        elif isinstance(node, ast.AnnAssign) or type(node).__name__ == "TypeAlias":  # Python 3.12
            named = [node.target if isinstance(node, ast.AnnAssign) else node.name]
        for name in named:
            if isinstance(name, ast.Name) and TYPE_NAME.match(name.id):
                yield name.id


def test_no_two_types_have_one_name() -> None:
    """A reader who searches for a name finds one meaning."""
    places: dict[str, list[str]] = {}
    for path in FILES:
        for name in type_names(path.read_text(encoding="utf-8")):
            places.setdefault(name, []).append(str(path.relative_to(ROOT)))
    twice = {name: files for name, files in places.items() if len(files) > 1}
    assert not twice


def test_the_check_sees_what_names_a_type() -> None:
    text = "class A: ...\nRow = dict[str, str]\nKind: TypeAlias = int\nMOST = 3\nT = TypeVar('T')\nx = 1\n"
    assert list(type_names(text)) == ["A", "Row", "Kind"]
    if sys.version_info >= (3, 12):
        assert list(type_names("type Node = list[Node]\n")) == ["Node"]


def tiny_numbers(text: str) -> set[float]:
    """Numbers in functions that stand for 0, without a name that says their unit and reason."""
    found: set[float] = set()
    for node in ast.walk(parsed(text)):
        if isinstance(node, ast.FunctionDef | ast.Lambda):
            values = [n.value for n in ast.walk(node) if isinstance(n, ast.Constant)]
            found |= {v for v in values if isinstance(v, float) and 0 < v <= TINY}
    return found


def test_numbers_of_the_pipeline_that_stand_for_0_have_a_name() -> None:
    for path in sorted((ROOT / "pipeline").rglob("*.py")):
        found = tiny_numbers(path.read_text(encoding="utf-8"))
        assert not found, f"{path.relative_to(ROOT)}: {found}"


def test_the_check_sees_a_number_that_stands_for_0() -> None:
    named, bare = "LEAST_S = 1e-12\n", "def f(x):\n    return 1 / max(x, 1e-12) + 1e-9\n"
    assert tiny_numbers(named + bare) == {1e-12, TINY}
    assert not tiny_numbers(named)


def caught(text: str) -> set[str]:
    """Names of the errors that handlers of a file name."""
    return {
        name.id
        for node in ast.walk(parsed(text))
        if isinstance(node, ast.ExceptHandler) and node.type is not None
        for name in ast.walk(node.type)
        if isinstance(name, ast.Name)
    }


def test_a_wrong_model_is_met_where_commands_and_workers_end_alone() -> None:
    """Nobody on the way may take it for a figure that failed, as its root error."""
    met: dict[str, list[str]] = {"NestingError": [], "FlexsplineError": []}
    for path in FILES:
        text = path.read_text(encoding="utf-8")
        if any(name in text for name in met):
            for name in met.keys() & caught(text):
                met[name].append(str(path.relative_to(ROOT)))
    workers = ["pipeline/study/evaluate.py", "pipeline/study/verify.py"]
    ends = [*workers, "results/job.py", "results/studio/questions.py"]
    assert met == {"NestingError": ends, "FlexsplineError": []}


def test_the_check_sees_what_is_caught() -> None:
    text = "try:\n    f()\nexcept (A, B) as x:\n    pass\nexcept C:\n    raise\n"
    assert caught(text) == {"A", "B", "C"}


CONSTANT_ELSEWHERE = re.compile(r"`(?:\w+\.)*(\w+)\.([A-Z][A-Z_]*[A-Za-z_0-9]*)`")
"""In comments: the file and its constant, or its class."""
LIBRARIES = {"optuna"}
"""Of which comments name a class."""


def lost_references(text: str, names: Mapping[str, set[str]]) -> Iterator[str]:
    """Constants and classes that comments name with their file, which that file does not have."""
    for m in CONSTANT_ELSEWHERE.finditer(text):
        if m[1].islower() and m[1] not in LIBRARIES and m[2] not in names.get(m[1], ()):
            yield f"{m[1]}.{m[2]}"


@cache
def names_by_file() -> dict[str, set[str]]:
    """All names that a file of the program defines or imports, by the file's name."""
    names: dict[str, set[str]] = {}
    for path in FILES:
        nodes = list(ast.walk(parsed(path.read_text(encoding="utf-8"))))
        here = names.setdefault(path.stem, set())
        here |= {n.id for n in nodes if isinstance(n, ast.Name)}
        here |= {n.name for n in nodes if isinstance(n, ast.ClassDef | ast.alias)}
    return names


def test_constants_that_comments_name_are_where_they_say() -> None:
    lost = {
        f"{path.relative_to(ROOT)}: {name}"
        for path in FILES
        for name in lost_references(path.read_text(encoding="utf-8"), names_by_file())
    }
    assert not lost


def test_the_check_sees_a_constant_that_has_moved() -> None:
    text = "as `lobes.LOBE_BULK`, `solid.lobes.MOST` and `gone.LEAST_K`; `key.torque_Nm`"
    assert list(lost_references(text, {"lobes": {"LOBE_BULK"}})) == ["lobes.MOST", "gone.LEAST_K"]


def programs(text: str) -> Iterator[ast.Module]:
    """A test file, and the programs in its strings that it runs in processes of their own."""
    tree = parsed(text)
    yield tree
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            with suppress(SyntaxError, ValueError):
                if "flexspline" in node.value:
                    yield parsed(node.value)


def is_private(name: str) -> bool:
    return name.startswith("_") and not name.startswith("__") and name != "_"


def private_names(path: Path) -> set[str]:
    """Private functions, classes, variables, methods and attributes that a file of the program defines."""
    names: set[str] = set()
    for node in ast.walk(parsed(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            names.add(node.attr)
    return {n for n in names if is_private(n)}


@cache
def private() -> frozenset[str]:
    """Of the whole program; looked for by the tests, not by every process that collects them."""
    return frozenset[str]().union(*map(private_names, FILES))


def called(node: ast.Call) -> str:
    """The last name of what is called."""
    return getattr(node.func, "attr", getattr(node.func, "id", ""))


def private_uses(text: str) -> Iterator[str]:
    """Private names of the program that a test file imports, reads, or names for `monkeypatch`."""
    for tree in programs(text):
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("flexspline"):
                yield from (alias.name for alias in node.names if is_private(alias.name))
            elif isinstance(node, ast.Attribute) and node.attr in private():
                if not (isinstance(node.value, ast.Name) and node.value.id in ("self", "cls")):
                    yield node.attr
            elif isinstance(node, ast.Call) and called(node).endswith("setattr"):
                words = [a.value for a in node.args if isinstance(a, ast.Constant)]
                yield from (w for w in map(str, words) if w.rpartition(".")[2] in private())


def test_tests_use_no_private_name_of_the_program() -> None:
    for path in sorted((ROOT / "tests").rglob("*.py")):
        found = list(private_uses(path.read_text(encoding="utf-8")))
        assert not found, f"{path.relative_to(ROOT)}: {', '.join(found)}"


@pytest.mark.parametrize(
    "use",
    [
        "from flexspline.geometry.outline import {}",
        "meridian.{}(1)",
        "monkeypatch.setattr(meridian, '{}', None)",
        "CODE = 'from flexspline.geometry.outline import {}'",
    ],
)
def test_the_check_sees_a_private_name(use: str) -> None:
    assert list(private_uses(use.format("_ring"))) == ["_ring"]


def test_a_diagnosis_with_given_stiffnesses_loads_no_solver() -> None:
    """They are a third of a second of its three."""
    code = (
        "import sys, flexspline.results.diagnosis.diagnose\n"
        "print(sorted({'skfem', 'pypardiso', 'cadquery', 'flexspline.pipeline.analysis'} & set(sys.modules)))"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def test_a_backlash_with_given_stiffnesses_loads_no_solver(tmp_path: Path) -> None:
    """They are half of its time."""
    ask = ["backlash", "examples/xb1-40.toml", "--Kb", "3e4", "--Ke", "2e4", "--out", str(tmp_path)]
    code = (
        "import sys; from flexspline.results.cli import app\n"
        f"app({ask}, standalone_mode=False)\n"
        "print(sorted({'scipy', 'skfem', 'flexspline.pipeline.analysis'} & set(sys.modules)))"
    )
    out = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT
    )
    assert out.stdout.splitlines()[-1] == "[]"


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys, flexspline.results.cli\n"
        "heavy = {'numpy','scipy','pydantic','cadquery','trimesh','skfem','pyvista','matplotlib'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"
