"""Names and versions of the libraries used, for the report's last section."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version

LIBRARIES = (
    "cadquery", "pytetwild", "scikit-fem", "pypardiso", "numpy", "scipy",
    "pyvista", "matplotlib", "typst",
)  # fmt: skip


def library_versions() -> dict[str, str]:
    """Python's version and those of the libraries that are installed; imports none of them."""
    versions = {"Python": platform.python_version()}
    for name in LIBRARIES:
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            continue  # pypardiso does not exist on Arm
    return versions
