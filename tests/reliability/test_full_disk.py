"""A full disk, a disk mounted read-only, a file in the way: one line, nothing half-written.

A full disk is status 1; a folder that cannot be made or written to is refused before the work, with status 2.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import bases
import pytest
from bases import CUP, GIVEN, head
from in_process import Ended, flexspline
from shell import run

from flexspline.pipeline.cache import Cache
from flexspline.pipeline.study.load import load_study
from flexspline.pipeline.study.run import trial_store_of

FREE_BYTES = 24_000
"""Room for result.json and one small picture, not for more."""


@contextmanager
def disk(folder: Path, *options: str) -> Iterator[Path]:
    """A small file system at `folder` while the context lasts; skips where none can be mounted."""
    if sys.platform != "linux" or os.geteuid() != 0 or shutil.which("mount") is None:
        pytest.skip("mounting a file system takes root on Linux")
    folder.mkdir()
    command = ["mount", "-t", "tmpfs", *options, "tmpfs", str(folder)]
    if subprocess.run(command, capture_output=True, check=False).returncode != 0:
        pytest.skip("mounting a file system takes root on Linux")
    try:
        yield folder
    finally:
        subprocess.run(["umount", "-l", str(folder)], check=True)


@pytest.fixture
def full(tmp_path: Path) -> Iterator[Path]:
    """A folder on a disk with a few kilobytes left."""
    with disk(tmp_path / "full", "-o", "size=128k") as folder:
        there = os.statvfs(folder)
        (folder / "others").write_bytes(b"x" * (there.f_bavail * there.f_frsize - FREE_BYTES))
        yield folder


@pytest.fixture
def read_only(tmp_path: Path) -> Iterator[Path]:
    """A folder on a disk that is mounted read-only, which binds root too."""
    with disk(tmp_path / "read only", "-o", "ro,size=64k") as folder:
        yield folder


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cup and shaft without holes: bodies of revolution."""
    return bases.plain(tmp_path_factory.mktemp("plain"))


def failed(ended: Ended, disk: str) -> None:
    status, needle = WHERE_IT_GOES[disk]
    assert ended.status == status, ended
    assert needle in ended.said[0]


WHERE_IT_GOES = {
    "full": (1, "No space left on device"),
    "read_only": (2, "Read-only file system"),
    "full for a database": (1, "disk is full"),
}


@pytest.mark.parametrize("disk", ["full", "read_only"])
def test_a_diagnosis(disk: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    there: Path = request.getfixturevalue(disk)
    measured = tmp_path / "points.csv"
    measured.write_bytes(head("size-40-end-points"))
    ended = flexspline("diagnose", CUP, measured, *GIVEN, "--out", there / "out", folder=there)
    failed(ended, disk)
    # what was computed is not lost with the files
    assert ("no file was written. The verdict: " in ended.said[0]) == (disk == "full")
    if disk == "full":  # the file that has no room is named, not the design
        assert ended.said[0].startswith(f"flexspline: {there / 'out'}")
        assert str(CUP) not in ended.said[0]


@pytest.mark.parametrize("disk", ["full", "read_only"])
def test_a_backlash_sum(disk: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    there: Path = request.getfixturevalue(disk)
    if disk == "full":
        filler = there / "others"
        filler.write_bytes(filler.read_bytes() + b"x" * FREE_BYTES)
    failed(flexspline("backlash", CUP, *GIVEN, "--out", there / "out", folder=there), disk)


def every_command(folder: Path) -> dict[str, list]:
    """The words of each command that takes --out, without it."""
    study, history = folder / "study.toml", folder / "history.csv"
    study.write_text(bases.study(folder), encoding="utf-8")
    history.write_bytes(head("size-40-end-points"))
    return {
        **{name: [name, CUP] for name in (
            "run", "stiffness", "backlash", "gear", "export", "sensitivity")},
        "study": ["study", study],
        "diagnose": ["diagnose", CUP, history],
        "predict": ["predict", CUP, history, "--model", folder / "model.toml"],
    }  # fmt: skip


COMMANDS = (
    "run", "stiffness", "backlash", "gear", "export", "sensitivity", "study", "diagnose", "predict",
)  # fmt: skip


@pytest.mark.parametrize("command", COMMANDS)
def test_a_folder_that_cannot_be_made_is_refused_before_the_work(
    command: str, tmp_path: Path
) -> None:
    """Below a file; with a name longer than file systems take (255 bytes)."""
    words = every_command(tmp_path)[command]
    (tmp_path / "file").write_bytes(b"of somebody")
    for out, reason in (
        (tmp_path / "file" / "in", "Not a directory"),
        (tmp_path / ("n" * 300), "too long"),
    ):
        ended = flexspline(*words, "--out", out, folder=tmp_path)  # one line
        assert ended.status == 2, ended
        assert "--out" in ended.said[0]
        assert reason in ended.said[0]
    assert (tmp_path / "file").read_bytes() == b"of somebody"


def test_a_folder_that_can_be_made_is_not_left_by_a_command_that_refuses(tmp_path: Path) -> None:
    measured = tmp_path / "none.csv"
    out = tmp_path / "made" / "for" / "a moment"
    ended = flexspline("diagnose", CUP, measured, "--out", out, folder=tmp_path)
    assert ended.status == 2
    assert "none.csv" in ended.said[0]
    assert list(tmp_path.iterdir()) == []


def test_a_read_only_disk_is_said_before_the_work(read_only: Path, tmp_path: Path) -> None:
    failed(flexspline("gear", CUP, "--out", read_only / "out", folder=tmp_path), "read_only")


def test_a_folder_in_the_way_of_a_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "result.json").mkdir()
    ended = flexspline("backlash", CUP, *GIVEN, "--out", tmp_path, folder=tmp_path)
    assert ended.status == 2
    assert "--out" in ended.said[0]
    assert "result.json is a folder" in ended.said[0]


@pytest.mark.parametrize("disk", ["full", "read_only"])
def test_a_study(disk: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    """Its database meets the full disk, in SQLite's words."""
    there: Path = request.getfixturevalue(disk)
    file = tmp_path / "study.toml"
    file.write_text(bases.study(tmp_path), encoding="utf-8")
    ended = flexspline("study", file, "--out", there / "out", folder=there)
    failed(ended, "full for a database" if disk == "full" else disk)


@pytest.mark.parametrize("bytes_left", [9000, 40_000, "another file"])
def test_a_study_s_damaged_database(bytes_left: int | str, tmp_path: Path) -> None:
    """To run the command again would not help, so that is not said."""
    file = tmp_path / "study.toml"
    file.write_text(bases.study(tmp_path), encoding="utf-8")
    own = tmp_path / "out" / "study.db"
    trial_store_of(load_study(file), own.parent)
    if isinstance(bytes_left, int):
        os.truncate(own, bytes_left)
    else:
        own.write_bytes(b"not a database\n" * 1000)
    ended = flexspline("study", file, "--out", own.parent, folder=tmp_path)
    assert ended.status == 1, ended
    (line,) = ended.said
    assert "damaged: move it away, or choose another --out" in line
    assert "resume" not in line
    assert str(own) in line


@pytest.mark.parametrize("disk", ["full", "read_only"])
def test_a_cache_without_room_is_no_reason_to_stop(
    disk: str, plain: Path, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    there: Path = request.getfixturevalue(disk)
    if disk == "full":
        filler = there / "others"
        filler.write_bytes(filler.read_bytes() + b"x" * FREE_BYTES)
    done = run("backlash", plain, "--out", tmp_path / "out", "--json", cache=there / "cache")
    assert done.returncode == 0, done.stderr
    assert f"could not store a result in {there}" in done.stderr
    assert json.loads(done.stdout)["K_b_Nm_per_rad"] > 0


def test_a_file_in_the_place_of_the_folder(tmp_path: Path) -> None:
    (tmp_path / "out").write_bytes(b"")
    ended = flexspline("backlash", CUP, *GIVEN, "--out", tmp_path / "out", folder=tmp_path)
    assert ended.status == 2
    assert (tmp_path / "out").read_bytes() == b""


@pytest.mark.long
def test_export_and_run(full: Path, plain: Path, tmp_path: Path) -> None:
    """CAD's and VTK's writers say nothing of a full disk; no file of theirs may pass for a whole one."""
    for command in ("export", "run"):
        done = run(command, plain, "--out", full / "out", cache=tmp_path / "cache")
        assert done.returncode == 1, done.stderr
        assert "No space left on device" in done.stderr.splitlines()[-1]
        assert [p.name for p in full.rglob("*") if p.name.startswith(".")] == []
        for made in full.rglob("*.step"):
            assert made.read_bytes().rstrip().endswith(b"END-ISO-10303-21;")


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no limit on the size of files")
@pytest.mark.parametrize("largest", [100, 3_000_000], ids=["of CAD", "of a mesh"])
def test_a_limit_on_the_size_of_files(largest: int, tmp_path: Path) -> None:
    """Of CAD's writers, which say nothing of it, and of ours."""
    import resource

    from flexspline.results.export import ExportError, write_whole

    def write(made: Path) -> None:
        try:
            made.write_bytes(b"x" * 4_000_000)
        except OSError:
            if largest == 100:
                return
            raise

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (largest, before[1]))
    try:
        with pytest.raises((ExportError, OSError), match=r"\(TMPDIR\)") as said:
            write_whole(tmp_path / "flexspline.stl", write)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert "export-" not in str(said.value)  # a folder that has gone
    assert list(tmp_path.iterdir()) == []


@pytest.mark.long
def test_a_full_scratch_disk(full: Path, plain: Path, tmp_path: Path) -> None:
    done = run("export", plain, "--out", tmp_path / "out", cache=tmp_path / "cache", scratch=full)
    assert done.returncode == 1, done.stderr
    assert "Traceback" not in done.stderr
    assert "full" in done.stderr.splitlines()[-1] or "No space" in done.stderr.splitlines()[-1]
    assert list((tmp_path / "out").glob("*")) == []


def test_a_result_that_cannot_be_stored_is_kept_for_this_command_and_told_once() -> None:
    said: list[str] = []
    made: list[int] = []
    cache = Cache(Path("/dev/null/cache"), said.append)
    for number in (1, 2, 1):
        assert cache.get("stage", {"n": number}, lambda n=number: made.append(n) or n)[0] == number
    assert made == [1, 2]
    assert len(said) == 1
    assert "FLEXSPLINE_CACHE" in said[0]
