"""Child processes: the command that starts one with the same modules, and its termination."""

from __future__ import annotations

import ctypes
import json
import os
import signal
import sys

PR_SET_PDEATHSIG = 1
"""Of Linux's prctl(2)."""
_START = """import json, sys
sys.path[:] = json.loads(sys.argv.pop(1))
from {module} import {function}
{function}(*sys.argv[1:])"""


def child_command(module: str, function: str, *arguments: str) -> list[str]:
    """Return a command that calls a module's function, with text arguments, in a new process.

    The child searches for modules where this process does, wherever it is started; without `-P` Python
    would look for the first ones in the child's own folder.
    """
    start = _START.format(module=module, function=function)
    return [sys.executable, "-P", "-c", start, json.dumps(sys.path), *arguments]


def end_with(parent: int) -> None:
    """End this process when its parent is killed, where the system tells it: on Linux."""
    if sys.platform != "linux":
        return
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:  # it was gone before the line above
        sys.exit("the program that started this process has ended")
