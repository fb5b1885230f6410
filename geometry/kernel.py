"""Tests whether the CAD kernel can be loaded: it needs OpenGL, which a bare Linux does not have."""

from __future__ import annotations

from functools import cache

from flexspline.geometry.errors import GeometryError, one_line
from flexspline.geometry.signals import held_signals


class CadKernelError(GeometryError):
    """The CAD kernel cannot be loaded, and which package it lacks."""


@cache
def load_kernel() -> None:
    """Load cadquery. An interruption waits: in the middle of loading, VTK and OCCT fail or crash by it.

    Raises
    ------
    CadKernelError : a library of the system is missing.
    """
    try:
        with held_signals():
            import cadquery  # noqa: F401
    except ImportError as fault:
        lacks = one_line(str(fault), 200)
        advice = "; on Debian and Ubuntu: apt-get install libgl1" if "libGL" in lacks else ""
        raise CadKernelError(f"the CAD kernel cannot be loaded ({lacks}){advice}") from None
