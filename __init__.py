"""Strain wave gears: stiffness with error bounds, stress, backlash, and what measurements say of them.

Lengths in mm, stresses in MPa, torques in N·m, stiffnesses in N·m/rad, angles as their names say. Every
name is loaded when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from flexspline.geometry.design import Design
    from flexspline.geometry.errors import FlexsplineError
    from flexspline.geometry.load import load_design
    from flexspline.pipeline.api import (
        backlash,
        gear,
        sensitivity,
        stiffness,
        stress,
        study,
    )
    from flexspline.pipeline.measured import diagnose
    from flexspline.results.predict import predict

    __version__: str

_PLACE = {
    "Design": "geometry.design",
    "FlexsplineError": "geometry.errors",
    "load_design": "geometry.load",
    "backlash": "pipeline.api",
    "diagnose": "pipeline.measured",
    "gear": "pipeline.api",
    "predict": "results.predict",
    "sensitivity": "pipeline.api",
    "stiffness": "pipeline.api",
    "stress": "pipeline.api",
    "study": "pipeline.api",
}

__all__ = [
    "Design",
    "FlexsplineError",
    "__version__",
    "backlash",
    "diagnose",
    "gear",
    "load_design",
    "predict",
    "sensitivity",
    "stiffness",
    "stress",
    "study",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import PackageNotFoundError, version

        try:
            value: Any = version("flexspline")
        except PackageNotFoundError:  # a source tree that nobody installed
            value = "unknown"
    elif name in _PLACE:
        value = getattr(import_module(f"flexspline.{_PLACE[name]}"), name)
    else:
        raise AttributeError(f"module 'flexspline' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
