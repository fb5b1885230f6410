"""Intel's oneMKL, where it is installed: not on Arm, for which it has no wheel."""

from __future__ import annotations

import ctypes
import os
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from flexspline.fea.address_space import LIBRARIES_BYTES, free_address_space_bytes

SETTINGS = {"MKL_DISABLE_FAST_MM": "1"}
"""oneMKL keeps a list of memory by thread, and in a copy of the process (a fork) that list may have no end: a
copy made after other threads had used oneMKL turned in `mkl_serv_malloc` for minutes. Without the list a
command takes 1 % more of the processor."""


@cache
def mkl() -> Any:
    """Return MKL's library; None where it does not exist or cannot be loaded."""
    if free_address_space_bytes() < LIBRARIES_BYTES:
        return None
    for name, value in SETTINGS.items():  # which it reads once
        os.environ.setdefault(name, value)
    # pypardiso would search the whole environment for MKL, twice, 0.3 s, and not the one that a virtual
    # environment may share packages with: it lies where wheels put it
    for prefix in (sys.prefix, sys.base_prefix):
        for library in sorted(Path(prefix, "lib").glob("libmkl_rt*")):
            os.environ.setdefault("PYPARDISO_MKL_RT", str(library))
    try:
        from pypardiso import PyPardisoSolver

        library = PyPardisoSolver().libmkl
    except (ImportError, OSError):
        return None
    _load_kernels(library)
    return library


def _load_kernels(library: Any) -> None:
    """Load the rest now, while there is room: oneMKL does so in its first sum, or ends the process."""
    one = np.ones(1)
    library["cblas_ddot"].restype = ctypes.c_double
    library["cblas_ddot"](1, address(one), 1, address(one), 1)


def address(array: np.ndarray) -> ctypes.c_void_p:
    """Return a pointer to the first entry of an array, which must outlive the call."""
    return ctypes.c_void_p(array.ctypes.data)
