"""The free address space of this process, if it is limited (`ulimit -v`, a job scheduler)."""

from __future__ import annotations

from math import inf
from pathlib import Path

from flexspline.geometry.errors import ComputationError

LIBRARIES_BYTES = 0.32e9
"""What oneMKL, its threads and OpenBLAS's buffers take when they are first used: 255 to 574 MB measured,
with two threads. Where they get less, oneMKL ends the process and OpenBLAS waits for ever."""
LEAST_BYTES = 0.9e9
"""Of a process that solves: libraries 0.57 GB, the rest for the matrices of three load cases at a time. With
0.9 GB `stiffness` answered examples/xb1-40.toml but for the shaft, with 0.65 GB it waited for ever."""


class AddressSpaceError(ComputationError):
    """The limit of this process leaves too little for any solve."""


def refuse_little_address_space() -> None:
    """Raise AddressSpaceError where no solve can be begun."""
    most = _limit_bytes()
    if most < LEAST_BYTES:
        raise AddressSpaceError(
            f"this process may have {most / 1e9:.2f} GB of address space (ulimit -v), and a solve needs"
            f" {LEAST_BYTES / 1e9:.1f} GB or more: raise the limit"
        )


def free_address_space_bytes() -> float:
    """Return the address space that the limit leaves to this process [bytes]; inf without a limit."""
    most = _limit_bytes()
    return most if most == inf else most - _used_bytes()


def _limit_bytes() -> float:
    try:
        import resource

        most, _ = resource.getrlimit(resource.RLIMIT_AS)
    except (ImportError, OSError):
        return inf
    return inf if most == resource.RLIM_INFINITY else float(most)


def _used_bytes() -> float:
    try:
        import resource

        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    except (ImportError, OSError):
        return 0.0
    return float(pages * resource.getpagesize())
