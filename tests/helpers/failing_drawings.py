"""Drawings that fail in every way, for the process that draws."""

import os
import signal
import time
from pathlib import Path


def good(path, words):
    print("a library's own words on standard output")
    path.write_text(f"drawn: {words}")


def array(path, values):
    path.write_bytes(values.tobytes())


def crashing(path, noted):
    with open(noted, "a", encoding="utf-8") as calls:
        calls.write("called\n")
    os.kill(os.getpid(), signal.SIGSEGV)


def raising(path):
    raise KeyError("scalars\nof another mesh")


def hanging(path):
    time.sleep(3600)


def meeting(path, folder, mine, other):
    """Ends when the other one has begun; within 30 s, or not at all."""
    (Path(folder) / mine).touch()
    end = time.monotonic() + 30
    while not (Path(folder) / other).exists():
        if time.monotonic() > end:
            raise TimeoutError(f"{other} has not begun")
        time.sleep(0.01)
    path.write_bytes(b"met")
