"""Whether VTK can draw on this machine: asked once, in a process of its own, which VTK crashes if not."""

from __future__ import annotations

import subprocess
import sys
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
_DRAW = """
from flexspline.geometry.errors import ComputationError
from flexspline.results.renders.opengl import choose_opengl
try:
    choose_opengl()
except ComputationError as error:
    raise SystemExit(str(error))
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(64, 64))
plotter.add_mesh(pyvista.Sphere())
picture = plotter.screenshot(None, return_img=True)
assert picture.max() > picture.min()
"""
LIBRARIES = (
    "libEGL.so.1", "libEGL.so", "libGL.so.1", "libGL.so", "libOSMesa.so", "libOSMesa.so.8",
    "libOSMesa.so.6",
)  # fmt: skip


@cache
def why_no_pictures() -> str:
    """The reason, "" where a sphere was drawn."""
    out = subprocess.run(
        [sys.executable, "-c", _DRAW],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if out.returncode == 0:
        return ""
    said = out.stderr.strip().splitlines()
    return f"VTK cannot draw here (exit status {out.returncode}): {said[-1] if said else ''}"


def machine_without(folder: Path) -> dict[str, str]:
    """Environment in which no OpenGL library loads, as on a bare Linux: files that are none come first."""
    for name in LIBRARIES:
        (folder / name).write_bytes(b"")
    return {"LD_LIBRARY_PATH": str(folder)}
