"""Drawings that fail in every way, for the process that draws."""

import os
import signal
import time


def good(path, words):
    print("a library's own words on standard output")
    path.write_text(f"drawn: {words}")


def array(path, values):
    path.write_bytes(values.tobytes())


def whose(path, values):
    path.write_text(str(id(values)))


def killed(path):
    """As the system does that has no memory left."""
    os.kill(os.getpid(), signal.SIGKILL)


def crashing(path, noted):
    with open(noted, "a", encoding="utf-8") as calls:
        calls.write("called\n")
    os.kill(os.getpid(), signal.SIGSEGV)


def raising(path):
    raise KeyError("scalars\nof another mesh")


def hanging(path):
    time.sleep(3600)
