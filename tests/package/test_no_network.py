"""No command opens a connection beyond this machine, or a port on it; `--help` answers at once.

A hook in every process, those that a study starts too, refuses connections, look-ups of names and
ports to listen at, and notes them. Where the system lets us, the commands also run in a network
namespace of their own, in which nothing but the loopback exists: that holds for libraries that bypass
Python.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from bases import head
from example_files import EXAMPLES

ROOT = Path(__file__).parents[2]
DESIGN = str(EXAMPLES / "xb1-40.toml")
K = ("--Kb", "31377", "--Ke", "43275")

GUARD = """
import os, socket, sys

def local(host):
    return host in ("", None, "localhost", "::1", b"localhost") or str(host).startswith("127.")

def watch(event, args):
    if event == "socket.connect":
        where = args[1]
        if args[0].family == socket.AF_UNIX or local(where[0]):
            return
    elif event in ("socket.getaddrinfo", "socket.gethostbyname"):
        where = args[0]
        if local(where) or where == socket.gethostname():
            return
    elif event == "socket.bind":  # other users of the machine reach it, whatever the address
        where = args[1]
    else:
        return
    with open(os.environ["NOTED"], "a") as noted:
        noted.write(f"{event} {where}\\n")
    raise OSError(f"no network here: {event} {where}")

sys.addaudithook(watch)
"""
LOOPBACK_UP = """
import fcntl, os, socket, struct, sys
request = struct.pack("16sh22x", b"lo", 1)  # IFF_UP
with socket.socket() as s:
    fcntl.ioctl(s, 0x8914, request)  # SIOCSIFFLAGS
os.execv(sys.argv[1], sys.argv[1:])
"""


def own_namespace() -> list[str]:
    """What to put before a command so that it sees no network; nothing where that is not allowed."""
    prefix = ["unshare", "-n", sys.executable, "-c", LOOPBACK_UP]
    try:
        tried = subprocess.run(
            [*prefix, sys.executable, "-c", ""], capture_output=True, check=False
        )
    except FileNotFoundError:
        return []
    return prefix if tried.returncode == 0 else []


@pytest.fixture(scope="module")
def prefix() -> list[str]:
    return own_namespace()


def guarded(
    call: list[str], prefix: list[str], folder: Path
) -> tuple[subprocess.CompletedProcess[str], str]:
    """Run python with the hook; also what the hook noted."""
    (folder / "sitecustomize.py").write_text(GUARD, encoding="utf-8")
    noted = folder / "noted.txt"
    env = {
        **os.environ, "PYTHONPATH": str(folder), "NOTED": str(noted),
    }  # fmt: skip
    out = subprocess.run(
        [*prefix, sys.executable, *call],
        cwd=folder, env=env, capture_output=True, text=True, check=False,
    )  # fmt: skip
    return out, noted.read_text(encoding="utf-8") if noted.exists() else ""


@pytest.mark.parametrize(
    "arguments",
    [
        pytest.param(["run", DESIGN], id="run"),
        pytest.param(["stiffness", DESIGN], id="stiffness", marks=pytest.mark.long),  # a part of it
        pytest.param(["diagnose", DESIGN, "sweep.csv", *K], id="diagnose", marks=pytest.mark.long),
        pytest.param(["study", "study.toml"], id="study"),
    ],
)
def test_commands_work_without_network(
    arguments: list[str], prefix: list[str], tmp_path: Path
) -> None:
    (tmp_path / "study.toml").write_text(
        f'design = "{DESIGN}"\n[vary]\n"flexspline.wall_thickness_mm" = {{ values = [0.4, 0.5] }}\n'
        '[run]\nmethod = "grid"\nworkers = 1\n',
        encoding="utf-8",
    )
    (tmp_path / "sweep.csv").write_bytes(head("xb1-40-sweep"))
    call = ["-m", "flexspline.results.cli", *arguments, "--out", str(tmp_path / "out")]
    out, noted = guarded(call, prefix, tmp_path)
    assert out.returncode == 0, out.stderr
    assert noted == ""


def test_the_hook_sees_a_look_up(tmp_path: Path) -> None:
    code = "import socket; socket.getaddrinfo('example.invalid', 80)"  # refused before it is asked
    out, noted = guarded(["-c", code], [], tmp_path)
    assert out.returncode != 0
    assert "example.invalid" in noted


def test_help_answers_within_half_a_second() -> None:
    """Processor time, the best of five: what other work on the machine cannot lengthen much."""
    taken = []
    for _ in range(5):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [sys.executable, "-m", "flexspline.results.cli", "--help"],
            cwd=ROOT, capture_output=True, check=True,
        )  # fmt: skip
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        taken.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    assert min(taken) < 0.5
