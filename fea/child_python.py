"""The command that starts a child of this Python, in which the same modules are found."""

from __future__ import annotations

import json
import sys

_START = """import json, sys
sys.path[:] = json.loads(sys.argv.pop(1))
from {module} import {function}
{function}(*sys.argv[1:])"""


def child_command(module: str, function: str, *arguments: str) -> list[str]:
    """Words of a command that calls a module's function with the arguments, as text, in a new process.

    The child searches for modules where this process does, wherever it is started; without `-P` Python
    would look for the first ones in the child's own folder.
    """
    start = _START.format(module=module, function=function)
    return [sys.executable, "-P", "-c", start, json.dumps(sys.path), *arguments]
