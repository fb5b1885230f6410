"""What a user's environment and keyboard do at awkward moments."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from example_files import EXAMPLES
from shell import run

from flexspline.geometry.signals import held_signals

INTERRUPTED_WHILE_LOADING = """
import os, signal, threading
from flexspline.geometry.kernel import load_kernel
threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    load_kernel()
except KeyboardInterrupt:
    load_kernel()
    print("interrupted, and loads")
"""


def test_charts_need_no_backend_of_the_user_s(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Jupyter exports its own to the commands that it starts; the report was then a traceback."""
    monkeypatch.setenv("MPLBACKEND", "module://nowhere.backend")
    sweep = EXAMPLES / "measured" / "size-40-end-points.csv"
    done = run(
        *("diagnose", EXAMPLES / "xb1-40.toml", sweep, "--Kb", 31300, "--Ke", 43000),
        *("--out", tmp_path / "out"),
        cache=tmp_path / "cache",
    )
    assert done.returncode == 0, done.stderr
    assert list((tmp_path / "out").glob("*.png"))


def test_held_signals_wait_and_then_come() -> None:
    reached = []

    def interrupted() -> None:
        with held_signals():
            signal.raise_signal(signal.SIGINT)
            reached.append("the end")

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert reached == ["the end"]
    before = signal.getsignal(signal.SIGINT)

    def held() -> None:
        with held_signals():  # another thread may set no handler
            reached.append("beside")

    worker = threading.Thread(target=held)
    worker.start()
    worker.join()
    assert reached == ["the end", "beside"]
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.cad
def test_an_interruption_does_not_break_the_loading_of_the_cad_kernel() -> None:
    """It came as "cannot be loaded (initialization failed)", or as a segmentation fault."""
    done = subprocess.run(
        [sys.executable, "-c", INTERRUPTED_WHILE_LOADING], capture_output=True, text=True
    )
    assert done.stdout == "interrupted, and loads\n", done.stderr
