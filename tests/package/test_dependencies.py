"""What the four rooms import is what pyproject.toml declares, each between two versions."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from functools import cache
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from source_tree import parsed

ROOT = Path(__file__).parents[2]
ROOMS = ("geometry", "fea", "pipeline", "results")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]
NEEDED = [Requirement(d) for d in PROJECT["dependencies"]]
USED_BY_THE_ROOMS = ("hdf5", "parquet")
OPTIONAL = [Requirement(d) for extra in USED_BY_THE_ROOMS for d in EXTRAS[extra]]
DECLARED = {canonicalize_name(r.name) for r in [*NEEDED, *OPTIONAL]}
NOT_IMPORTED = {"vtk": "bounds the version that pyvista draws with"}


def imported(source: str) -> set[str]:
    """Top-level names that a file imports, by statement, `import_module` or `importlib.resources`."""
    names = set()
    for node in ast.walk(parsed(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names.add(node.module)
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if called in ("import_module", "files", "__import__"):
                names.add(str(node.args[0].value))
    return {name.partition(".")[0] for name in names}


@cache
def third_party() -> frozenset[str]:
    files = (p for room in ROOMS for p in (ROOT / room).rglob("*.py"))
    found = set().union(*(imported(p.read_text(encoding="utf-8")) for p in files))
    return frozenset(found - set(sys.stdlib_module_names) - {"flexspline"})


def test_the_reading_sees_every_way_to_import() -> None:
    ways = "import a.b\nfrom c import d\nfiles('e')\nimport_module('f.g')\nfrom . import h\n"
    assert imported(ways) == {"a", "c", "e", "f"}


def test_everything_imported_is_declared() -> None:
    owners = packages_distributions()
    for name in sorted(third_party() & set(owners)):  # pypardiso is not everywhere
        assert {canonicalize_name(d) for d in owners[name]} & DECLARED, f"{name} is not declared"


def test_everything_declared_is_imported() -> None:
    owners = packages_distributions()
    used = {canonicalize_name(d) for name in third_party() for d in owners.get(name, [name])}
    assert {canonicalize_name(r.name) for r in NEEDED} - used == set(NOT_IMPORTED)


@pytest.mark.parametrize(
    "requirement",
    [r for group in [PROJECT["dependencies"], *EXTRAS.values()] for r in group if "[" not in r],
)
def test_each_has_the_lowest_tried_and_ends_before_a_major(requirement: str) -> None:
    bounds = {s.operator: s.version for s in Requirement(requirement).specifier}
    assert set(bounds) == {">=", "<"}
    assert re.fullmatch(r"\d+", bounds["<"]), "a major version"
