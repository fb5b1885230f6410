"""Tests whether OpenGL is available before VTK is used, because VTK crashes without it."""

from __future__ import annotations

import ctypes
import os
import sys

from flexspline.geometry.errors import ComputationError

EGL = ("libEGL.so.1", "libEGL.so")
OSMESA = ("libOSMesa.so", "libOSMesa.so.8", "libOSMesa.so.6")
X11 = ("libGL.so.1", "libGL.so")
ADVICE = "on Debian and Ubuntu: apt-get install libegl1 libgl1"


class OpenGLError(ComputationError):
    """No OpenGL library, so no picture of a part."""


def choose_opengl() -> None:
    """Tell VTK what to draw with, where the user has not.

    Raises
    ------
    OpenGLError : Linux without a library that it could take.
    """
    if not sys.platform.startswith("linux"):
        return  # Windows and macOS bring their own
    if os.environ.get("DISPLAY") and _loads(X11):
        return
    if _loads(EGL):
        # else VTK first looks for an X server and complains on stderr that there is none
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    elif not _loads(OSMESA):
        raise OpenGLError(f"no OpenGL library on this machine (libEGL.so.1); {ADVICE}")


def _loads(names: tuple[str, ...]) -> bool:
    for name in names:
        try:
            ctypes.CDLL(name)
        except OSError:
            continue
        return True
    return False
