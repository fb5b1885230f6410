"""Estimates the memory of a solve, and compares it with the machine's memory before the start.

Fits to Pardiso's own figures (iparm 16 and 17) and to resident memory, six-hole cup of 26 000 to 1.1
million unknowns, in docs/decisions.md.
"""

from __future__ import annotations

from math import inf, sqrt
from pathlib import Path
from typing import Literal

import psutil

from flexspline.fea.address_space import free_address_space_bytes
from flexspline.fea.errors import MemoryShortError
from flexspline.fea.pardiso import pardiso

SolverKind = Literal["direct", "iterative"]
DIRECT_BELOW = 25_000
"""Unknowns up to which factors are as fast as an iteration or faster. Without MKL, CPU s of a shaft of 41
100, another of 46 700 and a hat's of 52 100 unknowns by factors, then by iteration: 7.1 and 1.0, 6.3 and 1.2,
2.4 and 1.8; 20 300 0.6 either way. With MKL, seconds of factors (in single precision, with their own steps)
and of iteration, two threads: 30 000 0.74 and 0.25, 33 000 0.50 and 0.29, 39 400 0.6 and 0.28, 64 300 2.0 and
1.1, 97 000 2.8 and 1.2, 135 000 5.1 and 2.9, 173 000 8.8 and 2.2, 270 000 13.7 and 4.2; one thread, as beside
another program: 30 000 1.16 and 0.38, 39 400 1.15 and 0.43. Where an iteration takes many steps factors
follow (`steps_of_factors`)."""
THIN_BELOW, THIN_ENTRIES = 300_000, 75.0
"""The same with MKL for a part that is mostly surface: it has fewer entries per unknown (65 to 73 in cups of
one or two layers, 75 to 83 in shafts and thick hats), its factors are small, and its flat elements take many
steps (a cup with a wall of 1/200 of its diameter, 87 000 unknowns: 1.2 s by factors, 5 s by 150 steps, which
were not enough; another, 85 000: 2.7 and 6.4 s)."""
STEPS_PER_ROOT = 0.25
"""Steps of an iteration that take as long as factors, divided by √unknowns: 65, 87 and 120 for 52 000, 126
000 and 173 000 unknowns of three shafts."""
ENTRY_BYTES = 38.0
"""Bytes per entry of the matrix while it is factorised: the free part, its triangle, the ordering."""
FACTOR_BYTES = 72.0
"""Bytes of the factors in double over unknowns^(4/3), within 15 % from 26 000 to 600 000 unknowns. Single
precision takes half, but factors in double may have to follow."""
LU_FACTORS = 2.0
"""SuperLU keeps both triangles."""
ITERATION_ENTRY_BYTES = 24.0
"""Bytes per entry during an iteration: K by blocks in double and single precision (13), and the product with
the interpolation while it is made; 22 were measured for 173 000 and 270 000 unknowns."""
CORNER_SHARE = 1 / 7.0
"""Unknowns of the corners over all unknowns, at most. Measured: 1/7.3 to 1/8."""
ASSEMBLY_ENTRY_BYTES = 30.0
"""Bytes per entry while the matrix is assembled, the matrix included."""
ENTRIES_PER_UNKNOWN = 85.0
"""Entries per unknown, before the matrix exists. Measured: 71 to 81."""


def direct_bytes(unknowns: int, entries: float) -> float:
    """Return the memory that factors need beyond the assembled matrix [bytes]."""
    triangles = 1.0 if pardiso() else LU_FACTORS
    return ENTRY_BYTES * entries + triangles * FACTOR_BYTES * unknowns ** (4 / 3)


def iterative_bytes(unknowns: int, entries: float) -> float:
    """Return the memory of an iteration beyond the assembled matrix, with the corners' factors [bytes]."""
    corners = direct_bytes(round(CORNER_SHARE * unknowns), entries * CORNER_SHARE / 2)
    return ITERATION_ENTRY_BYTES * entries + corners


def check_before_assembly(unknowns: int) -> None:
    """Raise MemoryShortError where neither the assembly nor any solve after it can fit."""
    entries = ENTRIES_PER_UNKNOWN * unknowns
    matrix = 12 * entries  # bytes: a double and a 32-bit column each
    least = min(direct_bytes(unknowns, entries), iterative_bytes(unknowns, entries))
    need = max(ASSEMBLY_ENTRY_BYTES * entries, matrix + least)
    available = available_bytes()
    if need > available:
        raise MemoryShortError(unknowns, need, available)


def choose_solver(unknowns: int, entries: int, corners: bool, slow: bool = False) -> SolverKind:
    """Return the solver that fits into memory and is expected to be faster.

    `corners`: the mesh's interpolation is known, so iteration is possible; `slow`: it would take many steps.

    Raises
    ------
    MemoryShortError : no way fits.
    """
    available = available_bytes()
    factors = direct_bytes(unknowns, entries)
    steps = iterative_bytes(unknowns, entries) if corners else inf
    below = DIRECT_BELOW
    if pardiso() and (slow or entries < THIN_ENTRIES * unknowns):
        below = THIN_BELOW
    if factors <= available and (unknowns <= below or not corners):
        return "direct"
    if steps <= available:
        return "iterative"
    if factors <= available:
        return "direct"
    raise MemoryShortError(unknowns, min(factors, steps), available)


def steps_of_factors(unknowns: int, entries: int) -> float:
    """Return how many steps cost as much as factors; inf where those do not fit or are never used."""
    if unknowns > THIN_BELOW or direct_bytes(unknowns, entries) > available_bytes():
        return inf
    return STEPS_PER_ROOT * sqrt(unknowns)


def available_bytes() -> float:
    """Return the memory that this process may still take: of the machine, its container, its own limit."""
    return min(_machine_free_bytes(), container_free_bytes(), free_address_space_bytes())


def _machine_free_bytes() -> float:
    """Free memory of the machine without swapping [bytes]; inf if it is not known, as without /proc."""
    try:
        return float(psutil.virtual_memory().available)
    except OSError:
        return inf


def container_free_bytes(folder: Path = Path("/sys/fs/cgroup")) -> float:
    """Return the control group's limit less what it holds [bytes], inf where there is none.

    File pages that nobody uses will give way.
    """
    try:
        most = (folder / "memory.max").read_text(encoding="ascii").strip()
        used = float((folder / "memory.current").read_text(encoding="ascii"))
        lines = (folder / "memory.stat").read_text(encoding="ascii").splitlines()
        kinds = dict(line.split()[:2] for line in lines)
        idle = float(kinds.get("inactive_file", 0))
        return inf if most == "max" else float(most) - used + idle
    except (OSError, ValueError):
        return inf
