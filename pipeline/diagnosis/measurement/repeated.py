"""Whether the last rows of a sweep are its first ones once more: a file that was appended to itself."""

from __future__ import annotations

import numpy as np

from flexspline.pipeline.diagnosis.measurement.record import Sweep

FEWEST_REPEATED_ROWS = 20
"""Fewest rows that repeat. Two readings with a hundred different values each do so by chance once in 10⁴⁰
records."""


def copied_rows(sweep: Sweep) -> int:
    """How many rows at the end repeat those at the beginning to the last digit; 0 where none do.

    Readings of a rig have noise, so that two cycles are never the same. Where all of them are, the record has
    none, and nothing is said.
    """
    history, n = sweep.history, len(sweep)
    read = (
        history.torque_Nm + 1j * sweep.angle_arcsec
    )  # eight times as quick to sort as rows of two
    _, first, which = np.unique(read, return_index=True, return_inverse=True)
    earlier = first[which]
    behind = np.arange(n) - earlier
    if not behind.any():
        return 0
    shift = int(np.bincount(behind[behind > 0]).argmax())
    count = n - shift
    if count < FEWEST_REPEATED_ROWS or not (read[shift:] == read[:count]).all():
        return 0
    several = (
        len({*zip(history.unit[:shift].tolist(), history.cycle[:shift].tolist(), strict=True)}) > 1
    )
    return count if several else 0
