"""Parts of the torque programme that few parameters describe: holds, and smooth moves of many rows.

Torque there is known much better than by any reading: from the mean of a hold, from a polynomial over a way.
What the noise does to their coefficients stays, and it is alike in many rows: no row averages it out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import ceil

import numpy as np
from numpy.linalg import norm
from scipy.special import bdtr

from flexspline.pipeline.diagnosis.measurement.corners import corners_of
from flexspline.pipeline.diagnosis.measurement.floors import LEAST_TIME_S, FINEST_TORQUE_Nm
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.holds import holds
from flexspline.pipeline.diagnosis.measurement.lost_rows import losses
from flexspline.pipeline.diagnosis.measurement.moving_mean import moving_mean
from flexspline.pipeline.diagnosis.measurement.once import once
from flexspline.pipeline.diagnosis.measurement.torque_noise import (
    torque_noise_Nm,
    torque_noise_of_rows_Nm,
)

CORNER_ROWS = 4
"""Rows by which a hold's two ends together may differ from the corners there. Judgement."""
SEEN_SIGMAS = 3.0
"""Times the torque noise. A polynomial over a way that stands out by less does not come from the torque."""
LONGEST_OF_CYCLE = 0.75
"""Longest way over a cycle. A way from one turn to the next is half of a cycle, or a row more."""
MOST_DEGREE, TESTED = 11, 3
"""Half a cycle of a sine from peak to peak is told to 1e-8 of its height; and how many polynomials beyond the
last must not stand out: of a way with a centre every second one is zero. Of a curve these are told too, as it
may have a little of them; a straight way has none."""
AT_CORNER = 3
"""Rows by which noise may displace a corner. They are not used."""
KNOWN_SHARE = 0.8
"""Share of the ways that must be known if more are refused than by chance. A drive rounds all corners
alike."""
BUMP_ROWS, BUMP_SIGMAS = 20, 4.5
"""The residual of so many rows shows a bend, not noise, if its mean is off by more of its standard
deviations."""
END_ROWS, END_SIGMAS = (3, 6, 12, 24), 2.5
"""The same for the first and the last rows, where the drive rounds a corner."""
SHORTEST_WAY, ONE_STEP = 4, 0.7
"""Rows; and how much of what torque moves over fewer of them, noise and all, is a step if it lies between
two."""
REFUSED_BY_CHANCE, RECORDS = 0.06, 0.98
"""Share of straight ways whose ends or middle chance lets stand out (eight ends, four of them apart); and of
records, in which it refuses no more ways than are allowed."""
FEWEST_ROWS_PER_NUMBER = 20
"""A parabola about each row knows torque to 0.23 of its noise within 41 rows; so does a polynomial then."""


@dataclass(frozen=True)
class KnownWay:
    """Rows (m,) in order, and what is known of the torque there.

    Attributes
    ----------
    noise_Nm : (m,) of the readings, but for what the numbers take of it.
    doubt_Nm : (m, k) what the noise does to each of the numbers: independent columns of one deviation each.
    """

    rows: np.ndarray
    noise_Nm: np.ndarray
    doubt_Nm: np.ndarray

    @property
    def held(self) -> bool:
        """Whether torque rests in these rows."""
        return self.doubt_Nm.shape[1] == 1


@once
def programme_edges(history: History) -> list[np.ndarray]:
    """Of each unit: the first row, within it, of each way between two corners, and the last one's end.

    A corner beside a loss of rows lies in it: by the rows alone it is misplaced, and a way would reach over
    it. Losses side by side are a slower logger's rows.
    """
    corners, edges = corners_of(history), []
    for unit, rows in enumerate(history.unit_slices):
        t = history.time_or_rows(rows)
        turned = np.searchsorted(t, [c.time_s for c in corners if c.unit == unit])
        lost = losses(t, history.torque_Nm[rows]) + 1
        apart = np.diff(lost, prepend=-np.inf, append=np.inf) > 2 * AT_CORNER
        for after in lost[apart[:-1] & apart[1:]]:
            turned[np.abs(turned - after) <= AT_CORNER] = after
        edges.append(_stepped(np.unique([0, *turned, len(rows)]), history.torque_Nm[rows]))
    return edges


def _stepped(edges: np.ndarray, torque_Nm: np.ndarray) -> np.ndarray:
    """The edges of ways; a step from one row to the next between two rests is one edge and no way.

    Its two corners lie a row or two apart; the rows between them are those of the rests beside it.
    """
    kept = np.ones(len(edges), bool)
    at = edges.copy()
    for i in np.flatnonzero(np.diff(edges) < SHORTEST_WAY):
        if 0 < i < len(edges) - 2 and kept[i]:
            moves = np.abs(np.diff(torque_Nm[edges[i] - 1 : edges[i + 1] + 1]))
            most = int(moves.argmax())
            beside = torque_Nm[edges[i - 1] : edges[i]], torque_Nm[edges[i + 1] : edges[i + 2]]
            rests = all(
                len(way) >= FEWEST_ROWS_PER_NUMBER and np.ptp(way) < moves[most] for way in beside
            )
            if rests and moves[most] > ONE_STEP * moves.sum():
                at[i], kept[i + 1] = edges[i] + most, False
    return at[kept]


@once
def still(history: History) -> list[np.ndarray]:
    """Rows of each hold between two corners of the programme: a sine's turn ends at no corner."""
    way = np.zeros(len(history), int)
    for rows, edges in zip(history.unit_slices, programme_edges(history), strict=True):
        way[rows] = np.repeat(np.diff(edges), np.diff(edges))
    return [h for h in holds(history) if np.median(way[h]) <= len(h) + CORNER_ROWS]


@once
def known_ways(history: History) -> list[KnownWay]:
    """What lies between two corners, in parts of 3/4 of a cycle at the most, and holds of few rows.

    Where more ways bend than chance lets, as with a drive that rounds its corners, only holds are known.
    """
    if torque_noise_Nm(history) <= 0:
        return []
    ways = list(_ways(history))
    each = [_known(history, way, END_SIGMAS) for way in ways]
    refused = sum(own is None for own in each)
    up_to = bdtr(np.arange(len(each)), len(each), REFUSED_BY_CHANCE)
    if refused <= (up_to < RECORDS).sum():  # chance refused these
        each = [
            own or _known(history, way, BUMP_SIGMAS) for way, own in zip(ways, each, strict=True)
        ]
    elif refused > (1 - KNOWN_SHARE) * len(each):
        each = []
    known = [own for own in each if own is not None]
    left = np.ones(len(history), bool)
    for way in known:
        left[way.rows] = False
    holds_alone = (_known(history, h, END_SIGMAS, most=0) for h in still(history) if left[h].all())
    return known + [way for way in holds_alone if way is not None]


def _ways(history: History) -> Iterator[np.ndarray]:
    """Rows between two corners, of enough rows for a number; a hold's own may reach beyond its corners."""
    longest = LONGEST_OF_CYCLE * len(history) / history.cycle_count
    for rows, edges in zip(history.unit_slices, programme_edges(history), strict=True):
        for first, last in pairwise(edges.tolist()):
            parts = np.array_split(rows[first:last], ceil((last - first) / longest))
            yield from (way for way in parts if len(way) >= FEWEST_ROWS_PER_NUMBER)


def _known(
    history: History, way: np.ndarray, end_sigmas: float, most: int = MOST_DEGREE
) -> KnownWay | None:
    """By the fewest polynomials over a way that leave noise, `most` the highest; None where none do.

    0: by its mean. A way's first and last rows may be off by `end_sigmas` of their deviations.
    """
    torque, noise = history.torque_Nm[way], torque_noise_of_rows_Nm(history)[way]
    t = history.time_or_rows(way)
    x = 2 * (t - t[0]) / max(float(np.ptp(t)), LEAST_TIME_S) - 1
    tested = TESTED if len(way) >= FEWEST_ROWS_PER_NUMBER else 0
    if noise.min() < FINEST_TORQUE_Nm:
        return None
    if tested and len(np.unique(t)) < FEWEST_ROWS_PER_NUMBER:  # a clock of whole minutes
        return None
    most = min(most, max(len(way) // FEWEST_ROWS_PER_NUMBER - 1, 0))
    polynomials = np.polynomial.legendre.legvander(x, most + tested) / noise[:, None]
    inner = slice(AT_CORNER, len(way) - AT_CORNER) if tested else slice(None)
    basis, change = np.linalg.qr(polynomials[inner])
    along = basis.T @ (torque / noise)[inner]
    seen = np.abs(along) > SEEN_SIGMAS
    for degree in range(most + 1):
        if not seen[degree + 1 : degree + 1 + TESTED].any():
            count = 1 + (degree if degree <= 1 else min(degree + TESTED, most + tested))
            orthonormal = np.linalg.solve(change[:count, :count].T, polynomials[:, :count].T).T
            left = torque / noise - orthonormal @ along[:count]
            if _bends(left, orthonormal, inner, end_sigmas):
                return None
            # a pause may lie between the last rows and the others
            near = norm(orthonormal, axis=1) < 1
            if not near.any():
                return None
            return KnownWay(way[near], (noise * left)[near], noise[near, None] * orthonormal[near])
    return None


def _bends(left: np.ndarray, orthonormal: np.ndarray, inner: slice, end_sigmas: float) -> bool:
    """Whether what polynomials (m, k) leave (m,), in rows' deviations, is not noise, within or at an end."""
    mean, rows = moving_mean(left[inner], BUMP_ROWS // 2)
    if (np.abs(mean) * np.sqrt(rows)).max() > BUMP_SIGMAS:
        return True
    counts = [k for k in END_ROWS if 3 * k <= len(left)]
    ends = [slice(k) for k in counts] + [slice(-k, None) for k in counts]
    off = [
        left[e].mean() / np.hypot(len(left[e]) ** -0.5, norm(orthonormal[e].mean(axis=0)))
        for e in ends
    ]
    return bool(np.abs(off).max(initial=0.0) > end_sigmas)
