"""Where the gap is crossed: the only place that shows a shifted torque reading.

Naming causes leaves these rows out, because the side of the gap is not known there to the width of
the torque noise. Here they answer one question, with everything else as already fitted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.diagnosis.sweep.crossing.crossing_likelihood import (
    ENDS_RATIO,
    LEAST_WIDTH,
    CrossingRows,
    blurs_of,
    finer,
)

OFFSET_REACH = 0.35
"""Largest offset that is searched, over the largest torque. Judgement."""
INSIDE_SHARE = 0.9
"""Of OFFSET_REACH: offsets tried, so that rows lie on both sides of each."""
OFFSET_STEPS = 141
"""Odd, so that one of the offsets tried is 0; the best is refined between its neighbours."""
UNSEEN_SIGMAS = 3.0
"""Standard deviations of the torque noise. A smaller offset counts as none."""
EACH_SIDE, FEWEST_EACH_SIDE = 0.3, 4
"""Share of the largest torque that must be exceeded on both sides of zero, and by how many rows each.
Judgement."""
SEEN_RATIO = 2.0
"""Smallest gap over one reading's noise whose crossing is visible. Judgement."""
WITHIN_GAP = 0.25
"""Distance from the gap's middle, over the gap. A nearer row lies in the gap, which is crossed at its torque.
Judgement."""
FAR_BEHIND = 4.5
"""Nats: an offset three deviations from the best one is so much less likely."""
FINE_STEPS, ZOOMS = 161, 2
"""Offsets tried of those that are not far behind, and how often they are chosen again, each time nearer;
widths of soft ends too, in steps a quarter as far apart."""
UNSEEN_STEPS = 9
"""Offsets within the torque's noise, each of which counts as none: a quarter of its reach apart."""


@dataclass(frozen=True)
class Crossing:
    """Offset of the torque reading [N·m] with its standard deviation, and nats over no offset."""

    offset_Nm: float
    std_Nm: float
    nats: float


def crossing(
    torque_Nm: np.ndarray,
    left_arcsec: np.ndarray,
    gap_arcsec: np.ndarray | float,
    noise_arcsec: float,
    torque_noise_Nm: float,
    readings: np.ndarray | float = 1.0,
) -> Crossing | None:
    """Find the offset from rows near zero torque.

    Parameters
    ----------
    torque_Nm : (n,) readings. left_arcsec : (n,) measured angle less everything but the gap; what an
        offset does to the twist itself is in the zero, which is free. gap_arcsec : of all rows, or (n,) each
        row's own. readings : rows of the record of which each is the mean.

    Returns None where the gap is too small to see, or no rows lie near zero.
    """
    largest = float(np.abs(torque_Nm).max())
    gap = np.broadcast_to(gap_arcsec, torque_Nm.shape)
    if gap.max() < SEEN_RATIO * noise_arcsec or largest == 0:
        return None
    if not on_both_sides(torque_Nm):
        return None
    near = np.abs(torque_Nm) < OFFSET_REACH * largest
    if not near.any():
        return None
    width = max(torque_noise_Nm, LEAST_WIDTH * largest)
    blurs = blurs_of(width / largest)
    many = np.broadcast_to(readings, torque_Nm.shape)[near]
    rows = CrossingRows.of(torque_Nm[near], left_arcsec[near], gap[near], noise_arcsec, width, many)
    even = np.linspace(-OFFSET_REACH, OFFSET_REACH, OFFSET_STEPS) * largest * INSIDE_SHARE
    inside = rows.torque_Nm[np.abs(rows.left_arcsec) < WITHIN_GAP * rows.gap_arcsec]
    places = np.union1d(even, np.round(inside / width) * width)
    nats = rows.log_likelihood(places, blurs)
    for zoom in range(1, ZOOMS + 1):
        low, high = _not_far_behind(places, nats)
        likeliest = rows.likeliest(float(places[nats.argmax()]), blurs)
        blurs += finer(likeliest, ENDS_RATIO ** (4 / 4**zoom))
        beyond = width * max(
            1.0, likeliest.ends / 4**zoom
        )  # another width of the ends, another place
        places = np.linspace(low - beyond, high + beyond, FINE_STEPS)
        nats = rows.log_likelihood(places, blurs)
    # an offset within the torque's noise is none
    unseen = max(UNSEEN_SIGMAS * torque_noise_Nm, even[1] - even[0]) * np.linspace(
        -1, 1, UNSEEN_STEPS
    )
    none = rows.log_likelihood(unseen, blurs).max()
    weight = np.exp(nats - nats.max()) * np.gradient(places)
    mean = float(weight @ places / weight.sum())
    variance = float(weight @ (places - mean) ** 2 / weight.sum())
    return Crossing(mean, float(np.sqrt(variance)), float(nats.max() - none))


def _not_far_behind(places: np.ndarray, nats: np.ndarray) -> tuple[float, float]:
    """From the last place `FAR_BEHIND` before all others to the first one after them."""
    near = np.flatnonzero(nats > nats.max() - FAR_BEHIND)
    return float(places[max(near[0] - 1, 0)]), float(places[min(near[-1] + 1, len(places) - 1)])


def between_rows(torque_Nm: np.ndarray, place_Nm: float, nearest: int = 1) -> float:
    """Torque [N·m] between the `nearest` rows on either side of a place, of all crossings together.

    Cycles whose rows stand at other torques narrow it.
    """
    below, above = torque_Nm[torque_Nm < place_Nm], torque_Nm[torque_Nm > place_Nm]
    if min(len(below), len(above)) < nearest:
        return float(np.ptp(torque_Nm))
    after = np.partition(above, nearest - 1)[nearest - 1]
    return float(after + np.partition(-below, nearest - 1)[nearest - 1])


def on_both_sides(torque_Nm: np.ndarray) -> bool:
    """Whether the torque goes far enough to both sides of zero for a step between them to have a place.

    Less is enough for a chord to hold the gap (`../twist_ratio.py`) or for a loop's width at zero to be seen
    (`../magnitudes/friction_place.py`).
    """
    far = EACH_SIDE * np.abs(torque_Nm).max()
    return bool(min((torque_Nm > far).sum(), (torque_Nm < -far).sum()) >= FEWEST_EACH_SIDE)
