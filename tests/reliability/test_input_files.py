"""What is named as an input file and is none: refused in one line, by every command, without waiting."""

from __future__ import annotations

import os
import socket
import subprocess
from collections.abc import Callable
from itertools import product
from pathlib import Path

import pytest
from bases import CUP, GIVEN, head
from shell import command, environment

WAIT_S = 120
"""A command that waits for a pipe, or reads a device, never ends; a refusal takes a second at rest."""


def pipe(path: Path) -> Path:
    os.mkfifo(path)
    return path


def listening(path: Path) -> Path:
    before = Path.cwd()
    os.chdir(path.parent)  # a socket's whole path may have 107 bytes only
    try:
        socket.socket(socket.AF_UNIX).bind(path.name)
    finally:
        os.chdir(before)
    return path


def folder(path: Path) -> Path:
    path.mkdir()
    return path


def sparse(path: Path) -> Path:
    """A terabyte that takes no room."""
    with path.open("wb") as file:
        file.truncate(10**12)
    return path


def link_to_zero(path: Path) -> Path:
    path.symlink_to("/dev/zero")
    return path


def loop(path: Path) -> Path:
    path.symlink_to(path)
    return path


NO_FILES: dict[str, tuple[Callable[[Path], object], str]] = {
    "device": (lambda path: "/dev/zero", "is a device"),
    "link to a device": (link_to_zero, "is a device"),
    "pipe": (pipe, "is a pipe; write its content to a file first"),
    "socket": (listening, "is a socket"),
    "folder": (folder, "is a directory"),
    "terabyte": (sparse, "1000000000000 bytes; "),
    "nothing there": (lambda path: path, "no such file"),
    "standard input": (lambda path: "-", "standard input is not read; name a file"),
    "link to itself": (loop, "cannot be read (Too many levels of symbolic links)"),
    "file as a folder": (lambda path: CUP / "x", "cannot be read (Not a directory)"),
    "name too long": (lambda path: "x" * 5000, "cannot be read (File name too long)"),
}
COMMANDS: dict[str, Callable[[object, Path], tuple[object, ...]]] = {
    "design": lambda file, good: ("backlash", file, *GIVEN),
    "study": lambda file, good: ("study", file),
    "measured": lambda file, good: ("diagnose", CUP, file, *GIVEN),
    "model": lambda file, good: ("predict", CUP, good, "--model", file),
    "studio": lambda file, good: ("studio", file, "--no-browser"),
}


def test_every_command_refuses(tmp_path: Path) -> None:
    """In one process, so that all refusals cost one start; its memory stays below a limit."""
    good = tmp_path / "torque.csv"
    good.write_bytes(head("xb1-40-sweep"))
    calls, needles = [], []
    for number, (role, (make, needle)) in enumerate(product(COMMANDS, NO_FILES.values())):
        file = make(tmp_path / f"{number}.toml")
        if str(file) == "-" and role == "model":
            continue  # an option's value that begins with a dash is another option's matter
        calls.append([str(w) for w in (*COMMANDS[role](file, good), "--out", tmp_path / "out")])
        needles.append(needle)
        if role == "studio":
            calls[-1] = calls[-1][:-2]
    script = (
        "import resource, sys\n"
        "from typer.testing import CliRunner\n"
        "from flexspline.results.cli import app\n"
        "resource.setrlimit(resource.RLIMIT_AS, (4 << 30,) * 2)\n"
        f"for words in {calls!r}:\n"
        "    done = CliRunner().invoke(app, words)\n"
        "    print(done.exit_code, (done.stderr.splitlines() or [repr(done.exception)])[-1])\n"
    )
    done = subprocess.run(
        [command()[0], "-c", script], capture_output=True, text=True, check=False, cwd=tmp_path,
        env=environment(tmp_path / "cache"), timeout=WAIT_S,
    )  # fmt: skip
    lines = done.stdout.splitlines()
    assert len(lines) == len(calls), done.stderr
    for call, line, needle in zip(calls, lines, needles, strict=True):
        assert line.startswith("2 flexspline: "), (call, line)
        assert needle in line
    assert not (tmp_path / "out").exists()


def test_process_substitution_says_what_to_do(tmp_path: Path) -> None:
    line = ["bash", "-c", '"$@" <(cat /dev/null)', "bash", *command("diagnose", CUP)]
    done = subprocess.run(
        line, capture_output=True, text=True, check=False, timeout=WAIT_S,
        env=environment(tmp_path / "cache"),
    )  # fmt: skip
    assert done.returncode == 2
    assert done.stderr.endswith("is a pipe; write its content to a file first\n")


@pytest.mark.parametrize("name", ["/dev/stdin", "/dev/fd/0", "/proc/self/fd/0"])
def test_a_descriptor_of_a_file_is_refused(name: str, tmp_path: Path) -> None:
    """Its results would go into /dev/stdin.out; with --out it is refused as a pipe is."""
    if not Path(name).parent.exists():
        pytest.skip("not on this system")
    for out in ((), ("--out", tmp_path / "out")):
        with CUP.open("rb") as design:
            done = subprocess.run(
                [*command("backlash", name, *GIVEN), *map(str, out)], stdin=design, capture_output=True,
                text=True, check=False, env=environment(tmp_path / "cache"), timeout=WAIT_S,
            )  # fmt: skip
        assert done.returncode == 2
        assert (
            done.stderr == f"flexspline: {name}: stands for an open file; name that file itself\n"
        )
        assert not (tmp_path / "out").exists()


def test_a_link_to_a_file_is_read(tmp_path: Path) -> None:
    from flexspline.geometry.load import load_design

    (tmp_path / "link.toml").symlink_to(CUP)
    assert load_design(tmp_path / "link.toml") == load_design(CUP)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can become another user")
def test_a_file_that_may_not_be_read(tmp_path: Path) -> None:
    from flexspline.geometry.errors import DesignFileError
    from flexspline.geometry.load import load_design

    path = tmp_path / "closed.toml"
    path.write_bytes(CUP.read_bytes())
    path.chmod(0)
    for at in (tmp_path, *tmp_path.parents[:2]):
        at.chmod(0o755)
    os.seteuid(65534)
    try:
        with pytest.raises(DesignFileError, match=r"cannot be read \(Permission denied\)"):
            load_design(path)
    finally:
        os.seteuid(0)
