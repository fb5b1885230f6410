"""The mesher is another program's: killed, stopped, slow, orphaned. Each ends in one typed error."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import psutil
import pytest

from flexspline.fea.errors import MesherError
from flexspline.fea.solid import tetwild
from flexspline.fea.solid.tetwild import TetwildSettings, tetrahedralize

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
     [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)  # fmt: skip
LONG = TetwildSettings(0.015, 0.0005, stop_energy=3.5, time_limit_s=120)
"""A cube so fine that it takes minutes."""
PARENT = """
import sys
sys.path.insert(0, sys.argv[1])
from test_broken_mesher import CUBE, FACES, LONG, tetrahedralize
tetrahedralize(CUBE, FACES, LONG)
"""


def mesher_below(process: psutil.Process, within_s: float = 60) -> psutil.Process:
    """The mesher's process once it runs."""
    deadline = time.monotonic() + within_s
    while time.monotonic() < deadline:
        for child in process.children(recursive=True):
            try:
                if any("fea.solid.tetwild" in word for word in child.cmdline()):
                    return child
            except psutil.Error:
                continue
        time.sleep(0.02)
    raise TimeoutError("no mesher was started")


def while_meshing(act: Callable[[psutil.Process], object]) -> threading.Thread:
    """Do something to the mesher of this process, half a second after it began."""

    def later() -> None:
        child = mesher_below(psutil.Process())
        time.sleep(0.5)
        act(child)

    thread = threading.Thread(target=later)
    thread.start()
    return thread


def test_a_killed_mesher_is_an_error_with_advice() -> None:
    thread = while_meshing(lambda child: child.kill())
    with pytest.raises(MesherError, match="ended with status -9") as caught:
        tetrahedralize(CUBE, FACES, LONG)
    thread.join()
    assert caught.value.advice


def test_a_mesher_that_stands_still_is_stopped_at_its_time_limit() -> None:
    thread = while_meshing(lambda child: child.suspend())
    began = time.monotonic()
    limit = TetwildSettings(0.015, 0.0005, stop_energy=3.5, time_limit_s=4)
    with pytest.raises(MesherError, match="did not finish within 4 s"):
        tetrahedralize(CUBE, FACES, limit)
    thread.join()
    assert time.monotonic() - began < 4 + 5  # the limit, and the time to start and end a process
    assert not [c for c in psutil.Process().children() if c.status() == psutil.STATUS_STOPPED]


def test_a_mesher_that_says_nothing_readable(monkeypatch: pytest.MonkeyPatch) -> None:
    """A result cut short, as by a full disk in the child."""
    whole = subprocess.run

    def cut(command, **more):
        done = whole(command, **more)
        made = next(Path(word) for word in command if word.endswith("out.npz"))
        made.write_bytes(made.read_bytes()[:200])
        return done

    monkeypatch.setattr(tetwild.subprocess, "run", cut)
    with pytest.raises(MesherError, match="result cannot be read"):
        tetrahedralize(CUBE, FACES, TetwildSettings(0.5, 0.02))


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the child ends by its time limit")
def test_an_orphaned_mesher_ends_at_once(tmp_path: Path) -> None:
    parent = subprocess.Popen(
        [sys.executable, "-c", PARENT, str(Path(__file__).parent)],
        env=os.environ | {"TMPDIR": str(tmp_path)},
    )
    child = mesher_below(psutil.Process(parent.pid))
    time.sleep(0.5)
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    gone, _ = psutil.wait_procs([child], timeout=10)
    assert gone == [child]
