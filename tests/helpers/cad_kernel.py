"""Whether the CAD kernel loads on this machine: asked once, in a process of its own."""

from __future__ import annotations

import subprocess
import sys
from functools import cache
from pathlib import Path

_LOAD = """
from flexspline.geometry.kernel import CadKernelError, load_kernel
try:
    load_kernel()
except CadKernelError as error:
    raise SystemExit(str(error))
"""


@cache
def why_no_cad() -> str:
    """The reason, "" where it does."""
    out = subprocess.run(
        [sys.executable, "-c", _LOAD],
        cwd=Path(__file__).parents[2], capture_output=True, text=True, check=False,
    )  # fmt: skip
    return "" if out.returncode == 0 else out.stderr.strip().splitlines()[-1]
