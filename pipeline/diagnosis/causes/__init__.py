"""The causes that can be named: one file with one class each, found by itself.

A new file in this folder with a subclass of `Cause` is a new cause; nothing else needs to know it.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pkgutil import iter_modules

from flexspline.pipeline.diagnosis.causes.cause import Cause


@cache
def known_causes() -> dict[str, Cause]:
    """Every cause by its id."""
    for module in iter_modules(__path__):
        import_module(f"{__name__}.{module.name}")
    return {c.id: c() for c in sorted(Cause.__subclasses__(), key=lambda c: c.id)}
