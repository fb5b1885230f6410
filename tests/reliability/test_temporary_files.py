"""What a killed process left is cleared by the next; what a living one is writing is not."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import pytest

from flexspline.pipeline.cache import Cache
from flexspline.pipeline.process_id import UNKNOWN, ProcessId, parsed, started, this_process
from flexspline.pipeline.temporary_files import (
    FORGOTTEN_S,
    MARK,
    clear,
    mark,
    scratch_folder,
    unfinished,
    write_unfinished,
)
from flexspline.results.atomic import write_bytes
from flexspline.results.output_folder import folder_of
from flexspline.results.scratch import own_scratch

GONE = "from flexspline.pipeline.temporary_files import mark; print(mark())"


def _of(pid: int) -> ProcessId:
    """Another process of this machine and namespace."""
    return replace(this_process(), pid=pid, born=str(started(pid)))


@pytest.fixture(scope="module")
def of_the_dead() -> str:
    """How a process that is no more named its files."""
    done = subprocess.run([sys.executable, "-c", GONE], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_a_process_that_is_no_more_has_not_started() -> None:
    ended = subprocess.Popen([sys.executable, "-c", ""])
    assert started(ended.pid) is not None
    ended.wait()
    assert started(ended.pid) is None


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has /proc")
def test_a_process_that_is_hidden_is_not_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    """As /proc mounted with hidepid=2 answers for those of other users."""

    def hidden(path: Path, *_: object, **__: object) -> str:
        raise FileNotFoundError(errno.ENOENT, "No such file or directory", str(path))

    parent = _of(os.getppid())
    monkeypatch.setattr(Path, "read_text", hidden)
    assert started(parent.pid) == UNKNOWN
    assert parent.fate == "alive"


def test_the_next_write_clears_what_a_dead_process_left(of_the_dead: str, tmp_path: Path) -> None:
    (tmp_path / f"{of_the_dead}half.part").write_bytes(b"half")
    (tmp_path / f"{of_the_dead}folder").mkdir()
    (tmp_path / f"{of_the_dead}folder" / "in.npz").write_bytes(b"half")
    write_bytes(tmp_path / "result.json", b"{}")
    assert [p.name for p in tmp_path.iterdir()] == ["result.json"]


def test_a_full_folder_for_temporary_files_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A copy that does not fit names its source, whose disk is not full."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    said = rf"{tmp_path}'$"
    with (
        own_scratch(),
        pytest.raises(OSError, match=said) as full,
        scratch_folder("outer-"),
        scratch_folder("inner-") as folder,
    ):
        raise OSError(errno.ENOSPC, "No space left on device", "out/mesh.png", None, str(folder))
    assert full.value.strerror == (
        "No space left on device: the folder for temporary files (TMPDIR) is full"
    )
    with pytest.raises(OSError, match=r"mesh\.png"), scratch_folder("other-"):
        raise FileNotFoundError(errno.ENOENT, "No such file or directory", "mesh.png")


def test_a_limit_on_the_size_of_files_is_not_said_of_a_hidden_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with (
        own_scratch(),
        pytest.raises(OSError, match=r"TMPDIR\) takes no file of this size") as large,
        scratch_folder("export-") as folder,
    ):
        raise OSError(errno.EFBIG, "File too large", str(folder / "flexspline.med"))
    assert large.value.filename == str(tmp_path)


def test_living_processes_and_other_machines_keep_theirs(tmp_path: Path) -> None:
    kept = [
        tmp_path / f"{mark()}mine.part",
        tmp_path / f"{MARK}{_of(os.getppid())}-parents.part",
        tmp_path
        / f"{MARK}{replace(this_process(), machine='00000000', pid=999999999)}-elsewhere.part",
        tmp_path / ".flexspline-note.txt",
        tmp_path / "result.json",
    ]
    for path in kept:
        path.write_bytes(b"")
    assert clear(tmp_path) == []
    assert sorted(tmp_path.iterdir()) == sorted(kept)


def test_a_write_that_fails_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space"):
        write_unfinished(unfinished(tmp_path), b"data")
    assert list(tmp_path.iterdir()) == []


def test_scratch_files_lie_together(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with own_scratch():
        made = Path(tempfile.mkdtemp())
        assert made.parent.parent == tmp_path
        assert made.parent.name.startswith(mark())
    assert tempfile.gettempdir() == str(tmp_path)


WITHOUT_A_HOME = """
import tempfile
from pathlib import Path
from flexspline.results.scratch import own_scratch
with own_scratch():
    (Path(tempfile.mkdtemp()) / "file").write_bytes(b"")
    from matplotlib import get_configdir
    get_configdir()
"""


def test_scratch_files_go_together_and_after_those_of_libraries(tmp_path: Path) -> None:
    """A home that cannot be written to: matplotlib takes a temporary folder and clears it at the end."""
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    env = {k: v for k, v in os.environ.items() if not k.startswith(("XDG_", "MPL"))}
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_A_HOME], capture_output=True, text=True, check=True,
        env=env | {"HOME": "/dev/null/home", "TMPDIR": str(scratch)},
    )  # fmt: skip
    assert done.stderr == ""
    assert list(scratch.iterdir()) == []


def test_who_discards_says_so(
    of_the_dead: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    said: list[str] = []
    left = [tmp_path / f"{of_the_dead}scratch", tmp_path / "out" / f"{of_the_dead}half.part"]
    entry = tmp_path / "cache" / "stage" / f"{of_the_dead}entry.part"
    for path in (*left, entry):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b"half")
    with own_scratch():
        folder_of(tmp_path / "design.toml", tmp_path / "out", ())
    Cache(tmp_path / "cache", said.append).get("stage", {}, lambda: 1)
    heard = capsys.readouterr().err
    assert [path.name in heard for path in left] == [True, True]
    assert entry.name in said[0]
    assert not [path for path in (*left, entry) if path.exists()]


def test_no_temporary_folder_is_no_reason_to_stop(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", "/dev/null/nowhere")
    with own_scratch():
        assert tempfile.gettempdir() == "/dev/null/nowhere"


CLEAR = """
import sys
from pathlib import Path
from flexspline.pipeline.temporary_files import clear
print(clear(Path(sys.argv[1])))
"""
UNSHARED = ("unshare", "--pid", "--fork")


@pytest.mark.skipif(sys.platform != "linux", reason="pid namespaces are Linux's")
@pytest.mark.parametrize("own_proc", [True, False], ids=["own /proc", "the host's /proc"])
def test_another_container_of_the_same_host_name_leaves_ours(
    own_proc: bool, tmp_path: Path
) -> None:
    """In a new namespace our pid is nobody's, or another's."""
    words = [*UNSHARED, *(["--mount-proc"] if own_proc else [])]
    if subprocess.run([*words, "true"], check=False, capture_output=True).returncode != 0:
        pytest.skip("namespaces take root")
    (tmp_path / f"{mark()}scratch").mkdir()
    done = subprocess.run(
        [*words, sys.executable, "-c", CLEAR, str(tmp_path)],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout == "[]\n"
    assert len(list(tmp_path.iterdir())) == 1


def test_a_pid_given_again_is_another_process(tmp_path: Path) -> None:
    """A living pid, but another start."""
    before = replace(_of(os.getppid()), born="1")
    assert before.fate == "gone"
    (tmp_path / f"{MARK}{before}-half.part").write_bytes(b"half")
    assert len(clear(tmp_path)) == 1


@pytest.mark.parametrize(
    "other", [{"machine": "00000000"}, {"space": "1"}, {"space": "x"}, {"machine": "x"}], ids=str
)
def test_whose_owner_cannot_be_seen_stays_until_it_is_old(other: dict, tmp_path: Path) -> None:
    owner = replace(this_process(), pid=999_999_999, **other)
    assert owner.fate == "unknown"
    folder = tmp_path / f"{MARK}{owner}-scratch"
    folder.mkdir()
    file = folder / "mesh.npz"
    file.write_bytes(b"")
    long_ago = time.time() - FORGOTTEN_S - 60
    os.utime(folder, (long_ago, long_ago))
    assert clear(tmp_path) == []  # a file in it is new
    os.utime(file, (long_ago, long_ago))
    os.utime(folder, (long_ago, long_ago))
    assert clear(tmp_path) == [folder]
    assert not folder.exists()


def test_a_process_is_read_back_from_its_text() -> None:
    assert parsed(f"{this_process()}-name.part") == this_process()
    assert this_process().fate == "alive"
    for text in ("note.txt", "", "another/1/1", "8c3d0-1-", "-1-2-3-4"):
        assert parsed(text) is None
