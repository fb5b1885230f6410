"""The wheel and the source archive hold what they must and nothing else. Built here, without network."""

from __future__ import annotations

import tarfile
import zipfile
from email import message_from_string
from pathlib import Path

import pytest
from hatchling.builders.sdist import SdistBuilder
from hatchling.builders.wheel import WheelBuilder

ROOT = Path(__file__).parents[2]
ROOMS = ("geometry", "fea", "pipeline", "results")
TOP = {
    *ROOMS, "__init__.py", "py.typed", "tests", "examples", "benchmarks", "docs", ".ci",
    "README.md", "LICENSE", "CHANGELOG.md", "pyproject.toml", "PKG-INFO", ".gitignore",
}  # fmt: skip
JUNK = ("__pycache__", ".pyc", ".out/", ".egg-info", "_cache/", ".hypothesis", ".swp", ".orig")


def sources() -> set[str]:
    """Files of the four rooms and of the package itself, less what Python leaves beside them."""
    return {"__init__.py", "py.typed"} | {
        str(p.relative_to(ROOT))
        for room in ROOMS
        for p in (ROOT / room).rglob("*")
        if p.is_file() and "__pycache__" not in p.parts
    }


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    folder = str(tmp_path_factory.mktemp("wheel"))
    path = next(WheelBuilder(str(ROOT)).build(directory=folder, versions=["standard"]))
    return zipfile.ZipFile(path)


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> tarfile.TarFile:
    folder = str(tmp_path_factory.mktemp("sdist"))
    path = next(SdistBuilder(str(ROOT)).build(directory=folder, versions=["standard"]))
    return tarfile.open(path)


def test_wheel_holds_the_four_rooms_and_nothing_else(wheel: zipfile.ZipFile) -> None:
    names = {n for n in wheel.namelist() if ".dist-info/" not in n}
    assert names == {f"flexspline/{source}" for source in sources()}
    assert any(n.endswith(".typ") for n in names)  # the reports' templates
    assert not [n for n in names if any(j in n for j in JUNK)]


def test_wheel_says_what_it_needs_and_offers(wheel: zipfile.ZipFile) -> None:
    info = next(n for n in wheel.namelist() if n.endswith("/METADATA")).rpartition("/")[0]
    meta = message_from_string(wheel.read(f"{info}/METADATA").decode())
    assert meta["Name"] == "flexspline"
    assert meta["License-Expression"] == "MIT"
    assert {"hdf5", "parquet", "bench", "docs", "test"} == set(meta.get_all("Provides-Extra"))
    needed = [n for n in meta.get_all("Requires-Dist") if "extra ==" not in n]
    assert all(">=" in n for n in needed)  # each with the lowest version that was tried
    assert not [n for n in needed if n.startswith("ngsolve")]  # LGPL: for the benchmarks only
    assert f"{info}/licenses/LICENSE" in wheel.namelist()
    points = wheel.read(f"{info}/entry_points.txt").decode()
    assert "flexspline = flexspline.results.entry:main" in points


def test_source_archive_is_whole_and_clean(archive: tarfile.TarFile) -> None:
    files = {m.name.partition("/")[2]: m for m in archive.getmembers() if m.isfile()}
    assert {n.split("/")[0] for n in files} <= TOP
    assert sources() <= set(files)
    for kept in ("tests/conftest.py", "docs/theory.md", "examples/xb1-40.toml", ".ci/run"):
        assert kept in files
    assert not [n for n in files if any(j in n for j in JUNK)]
    assert max(m.size for m in files.values()) < 1_000_000  # nothing made by a run strayed in
