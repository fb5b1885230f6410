"""Several units in one file: the share of each cause in each unit."""

from __future__ import annotations

from math import inf, nan
from pathlib import Path

import numpy as np

from flexspline.pipeline.diagnosis.decision import Decision
from flexspline.pipeline.diagnosis.outcome import NamedCause, none_of
from flexspline.pipeline.diagnosis.sweep.identification.unit_amplitudes import UnitAmplitudes
from flexspline.pipeline.diagnosis.sweep.separate_units import UnitsApart
from flexspline.results.diagnosis.words import cause_title
from flexspline.results.figures.diagnosis.panels import DPI, titled
from flexspline.results.figures.diagnosis.seen import SweepPictureData, plain_names
from flexspline.results.figures.fitted_text import GROUND, thin_labels
from flexspline.results.sentences import capital
from flexspline.results.style import INK, MUTED, PALETTE, new_figure, save_png, styled

MOST_CAUSES = 4
"""Panels drawn, of the largest causes: together 8.2 inches high."""
PANEL, TOP, BOTTOM, BETWEEN = 1.25, 0.95, 0.6, 0.55
"""Inches, as in `panels`."""

UNDECIDED = "not decided"
"""Of a cause that a unit has only as an alternative."""


def shared_causes(shown: SweepPictureData) -> dict[str, UnitAmplitudes]:
    """How much of each cause each unit shows, by the cause's title; none for a single unit."""
    separate, causes = shown.analysis.apart, shown.diagnosis.outcome.causes
    if separate is None:
        shares = {c.id: shown.explained.shares.get(c.id) for c in causes}
    else:
        shares = {c.id: _sizes_apart(separate, c) for c in causes}
    titles = {capital(cause_title(c)).partition(" (")[0]: shares[c.id] for c in causes}
    shared = [(title, amplitudes) for title, amplitudes in titles.items() if amplitudes is not None]
    return dict(shared[:MOST_CAUSES])


def _sizes_apart(separate: UnitsApart, cause: NamedCause) -> UnitAmplitudes:
    """Sizes in units that were diagnosed each by itself, over the largest; NaN where a unit has this cause
    only as an alternative of another: 0 would say that it has none."""
    none = none_of(cause)
    judged = [j for j in separate.decisions.values() if j]
    in_units = [{c.id: c for c in j.causes}.get(cause.id) for j in judged]
    pairs = [
        (c.magnitude, c.magnitude_std) if c else (nan if _is_open(j, cause) else none, 0.0)
        for j, c in zip(judged, in_units, strict=True)
    ]
    size, std = np.array(pairs).T
    whole = max((size - none)[np.isfinite(size)], key=abs)
    split = sum(c.id == cause.id for c in separate.decision.causes) > 1 or None in in_units
    return UnitAmplitudes((size - none) / whole, std / abs(whole), inf if split else 0.0)


def _is_open(decision: Decision, cause: NamedCause) -> bool:
    """Whether a unit has the cause, or has it not, as far as its own rows tell."""
    return any(cause.id in c.alternatives for c in decision.causes)


def _verdict_words(share: UnitAmplitudes) -> str:
    if np.isnan(share.share).any():
        return UNDECIDED
    return "the units differ" if share.differ else "the same in all units"


def write_units(path: Path, shown: SweepPictureData, shares: dict[str, UnitAmplitudes]) -> None:
    """One panel per cause: 1 is the mean size, or the largest, 0 nothing."""
    separate = shown.analysis.apart
    names = plain_names(
        tuple(n for n, j in separate.decisions.items() if j)
        if separate
        else shown.explained.prepared.sweep.units
    )
    height = TOP + len(shares) * PANEL + (len(shares) - 1) * BETWEEN + BOTTOM
    x = np.arange(len(names))
    with styled():
        figure = new_figure(8.0, height, DPI)
        for i, (title, share) in enumerate(shares.items()):
            low = BOTTOM + (len(shares) - 1 - i) * (PANEL + BETWEEN)
            axes = figure.add_axes((0.095, low / height, 0.875, PANEL / height))
            axes.axhline(1, color=PALETTE[1], lw=1.4, ls=(0, (4, 3)))
            axes.axhline(0, color=MUTED, lw=0.8)
            axes.errorbar(
                x,
                share.share,
                yerr=2 * share.share_std,
                fmt="o",
                ms=5.5,
                color=INK,
                capsize=4,
                lw=1.4,
            )
            for place in np.flatnonzero(np.isnan(share.share)):
                axes.annotate(
                    UNDECIDED,
                    (place, 0.5),
                    ha="center",
                    va="center",
                    fontsize=9,
                    color=MUTED,
                    bbox=GROUND,
                )
            axes.set_title(f"{title}: {_verdict_words(share)}", fontsize=10.5, pad=6)
            top = float(np.nanmax(share.share + 2 * share.share_std))
            bottom = float(np.nanmin(share.share - 2 * share.share_std))
            axes.set_ylim(min(-0.15, bottom - 0.1), max(1.25, top + 0.1))
            axes.set_xlim(-0.5, len(names) - 0.5)
            axes.set_xticks(x, names if i == len(shares) - 1 else [""] * len(names))
            axes.set_ylabel("share")
            thin_labels(axes)
            axes.grid(axis="y")
        axes.set_xlabel("unit under test")
        titled(figure, 1 - 0.28 / height, "Effects in all units and in single units")
        save_png(figure, path)
