"""End points: every unit against the predicted envelope, where its ends lie, and the rivals."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis, UnitFinding
from flexspline.pipeline.diagnosis.end_points.race import Hypothesis
from flexspline.results.diagnosis.words import channel_words, figures_text, title_of
from flexspline.results.figures.diagnosis.panels import DPI
from flexspline.results.figures.diagnosis.seen import plain_names
from flexspline.results.figures.words import fit
from flexspline.results.style import ACCENT, INK, MUTED, PALETTE, new_figure, save_png, styled

MOST_UNITS = 30
MOST_RIVALS = 8
ROW = 0.42
"""Inches of a row of bars."""
FLAT = "an unnamed curve over torque"


def shown_units(analysis: EndPointAnalysis) -> list[UnitFinding]:
    """In the file's order; of very many, those furthest out."""
    units = list(analysis.units)
    if len(units) <= MOST_UNITS:
        return units
    worst = sorted(units, key=lambda u: u.p_value)[:MOST_UNITS]
    return [u for u in units if u in worst]


def write_envelope(path: Path, analysis: EndPointAnalysis) -> None:
    """Lost motion of each unit, and what a good unit may show."""
    units = shown_units(analysis)
    names = plain_names(tuple(u.unit for u in units))
    height = 1.55 + ROW * len(units)
    with styled():
        figure = new_figure(8.0, height, DPI)
        axes = figure.add_axes((0.13, 0.6 / height, 0.61, ROW * len(units) / height))
        ends, said = [], []
        for row, unit in enumerate(units):
            envelope = analysis.envelope_at(unit.torque_Nm)
            low, high = envelope.interval_arcsec
            first = row == 0
            axes.barh(
                row, high - low, left=low, height=0.66, color=PALETTE[0], alpha=0.15, lw=0,
                label="95 of 100 good units" if first else None,
            )  # fmt: skip
            axes.plot(
                [envelope.total_arcsec] * 2, [row - 0.33, row + 0.33], color=PALETTE[0], lw=2,
                label="simulation" if first else None,
            )  # fmt: skip
            limit = envelope.limit_arcsec()
            if np.isfinite(limit):
                axes.plot(
                    [limit] * 2, [row - 0.33, row + 0.33], color=MUTED, lw=1.4, ls=(0, (2, 1.5)),
                    label="most that clearance can give" if first else None,
                )  # fmt: skip
                ends.append(limit)
            colour = INK if unit.within else ACCENT
            axes.plot(
                unit.total_arcsec, row, "o", ms=7, color=colour, zorder=4,
                label="measured" if first else None,
            )  # fmt: skip
            ends += [low, high, unit.total_arcsec]
            words = "within" if unit.within else "beyond"
            said.append(axes.annotate(
                f"{unit.total_arcsec:.1f}″, {words} ({unit.z:+.1f} σ)".replace("-", "−"),
                (1.02, row), xycoords=("axes fraction", "data"), va="center", fontsize=9.5,
                color=colour, weight="normal" if unit.within else "bold", annotation_clip=False,
            ))  # fmt: skip
        fit(said, 0.235 * figure.bbox.width)
        room = 0.06 * (max(ends) - min(ends) + 1e-9)
        axes.set_xlim(min(ends) - room, max(ends) + room)
        axes.set_ylim(len(units) - 0.5, -0.5)
        torques = len(analysis.envelopes) > 1
        axes.set_yticks(range(len(units)), [
            f"unit {n}" + (f", ± {u.torque_Nm:g} N·m" if torques else "")
            for n, u in zip(names, units, strict=True)
        ])  # fmt: skip
        axes.tick_params(axis="y", length=0)
        axes.grid(axis="x")
        axes.set_xlabel("angle between −T and +T in arcsec")
        figure.text(
            0.035, 1 - 0.28 / height, "Lost motion of each unit against the prediction", fontsize=12,
            weight="bold", va="center",
        )  # fmt: skip
        figure.legend(
            loc="center left", bbox_to_anchor=(0.025, 1 - 0.64 / height), ncols=4, fontsize=9,
            columnspacing=1.3, handlelength=1.5, handletextpad=0.5, borderpad=0, markerscale=0.8,
        )  # fmt: skip
        save_png(figure, path)


def write_positions(path: Path, analysis: EndPointAnalysis) -> None:
    """Where each unit's two ends lie, and its middle."""
    units = shown_units(analysis)
    names = plain_names(tuple(u.unit for u in units))
    height = 1.55 + ROW * len(units)
    reach = analysis.mids.asymmetry_reach_arcsec
    with styled():
        figure = new_figure(8.0, height, DPI)
        axes = figure.add_axes((0.13, 0.6 / height, 0.61, ROW * len(units) / height))
        axes.axvspan(
            -reach,
            reach,
            color=PALETTE[2],
            alpha=0.25,
            lw=0,
            label="most that a stiffer direction can do",
        )
        axes.axvline(0, color=MUTED, lw=0.8)
        for row, unit in enumerate(units):
            half, first = unit.total_arcsec / 2, row == 0
            expected = unit.predicted_arcsec / 2
            axes.plot(
                [-expected, expected], [row - 0.22] * 2, color=PALETTE[0], lw=2.2, alpha=0.55,
                label="simulation" if first else None,
            )  # fmt: skip
            axes.plot(
                [unit.mid_arcsec - half, unit.mid_arcsec + half], [row + 0.08] * 2, "|-", color=INK, lw=1.6,
                ms=9, mew=1.6, label="measured, −T to +T" if first else None,
            )  # fmt: skip
            axes.plot(
                unit.mid_arcsec, row + 0.08, "o", color=INK, ms=5, label="middle" if first else None
            )
            axes.annotate(
                f"middle {unit.mid_arcsec:+.1f}″".replace("-", "−"), (1.02, row),
                xycoords=("axes fraction", "data"), va="center", fontsize=9.5, annotation_clip=False,
            )  # fmt: skip
        axes.set_ylim(len(units) - 0.5, -0.5)
        axes.set_yticks(range(len(units)), [f"unit {n}" for n in names])
        axes.tick_params(axis="y", length=0)
        axes.grid(axis="x")
        axes.set_xlabel("angle read in arcsec")
        figure.text(
            0.035,
            1 - 0.28 / height,
            "Where each unit's ends lie",
            fontsize=12,
            weight="bold",
            va="center",
        )
        figure.legend(
            loc="center left", bbox_to_anchor=(0.025, 1 - 0.64 / height), ncols=4, fontsize=9,
            columnspacing=1.3, handlelength=1.5, handletextpad=0.5, borderpad=0,
        )  # fmt: skip
        save_png(figure, path)


def write_rivals(path: Path, analysis: EndPointAnalysis) -> None:
    """What each explanation has for it, and what further measurements would tell."""
    ranked = sorted(analysis.hypotheses, key=lambda h: -h.score)[:MOST_RIVALS]
    names = plain_names(tuple(u.unit for u in analysis.units))
    plans = analysis.plans[:4]
    rows = len(ranked) + (len(plans) + 1.9 if plans else 0)
    height = 1.45 + 0.36 * rows
    with styled():
        figure = new_figure(8.0, height, DPI)
        top = 0.5
        axes = figure.add_axes((
            0.47, 1 - (top + 0.36 * len(ranked)) / height, 0.43, 0.36 * len(ranked) / height
        ))  # fmt: skip
        score = np.array([h.score for h in ranked])
        share = np.exp(score - score.max())
        share /= share.sum()
        axes.barh(
            range(len(ranked)), 100 * share, height=0.6,
            color=[PALETTE[1] if h.causes else "#dfe3e7" for h in ranked], edgecolor=INK, lw=0.6,
        )  # fmt: skip
        for row, value in enumerate(share):
            axes.annotate(
                f"{100 * value:.0f} %", (100 * value, row), (5, 0), textcoords="offset points", va="center",
                fontsize=9.5,
            )  # fmt: skip
        axes.set_yticks(range(len(ranked)), [_words(h, names) for h in ranked], fontsize=9.5)
        _bare(axes, len(ranked))
        axes.set_xlabel("share of the odds, of those shown, in %", fontsize=9.5)
        axes.set_xlim(0, 118 * share.max())
        figure.text(
            0.035,
            1 - 0.26 / height,
            "What could explain it",
            fontsize=12,
            weight="bold",
            va="center",
        )
        if plans:
            low = figure.add_axes((0.47, 0.55 / height, 0.43, 0.36 * len(plans) / height))
            sizes = [p.separation for p in plans]
            low.barh(range(len(plans)), sizes, height=0.6, color=PALETTE[2], edgecolor=INK, lw=0.6)
            for row, size in enumerate(sizes):
                low.annotate(
                    figures_text(size, 2), (size, row), (5, 0), textcoords="offset points", va="center",
                    fontsize=9.5,
                )  # fmt: skip
            low.set_yticks(range(len(plans)), [_plan(p.vary) for p in plans], fontsize=9.5)
            _bare(low, len(plans))
            low.set_xlim(0, 1.18 * max(*sizes, 1e-9))
            low.set_xlabel(
                "by how many times the noise the nearest rivals then differ", fontsize=9.5
            )
            figure.text(
                0.035, (0.55 + 0.36 * len(plans) + 0.22) / height, "What would tell them apart", fontsize=12,
                weight="bold", va="center",
            )  # fmt: skip
        save_png(figure, path)


def _bare(axes, rows: int) -> None:  # type: ignore[no-untyped-def]
    axes.set_ylim(rows - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    axes.grid(axis="x")


def _words(hypothesis: Hypothesis, names: tuple[str, ...]) -> str:
    if not hypothesis.causes:
        return "the simulation, within its uncertainty"
    titles = [
        FLAT if c.startswith("?") else title_of(c).partition(" (")[0] for c in hypothesis.causes
    ]
    text = " and ".join(titles)
    return text if hypothesis.own is None else f"{text}, unit {names[hypothesis.own]}"


def _plan(vary: str) -> str:
    return {
        "repeat": "the same end points again",
        "torque_Nm": "end points at other torques",
        "sweep": "a closed torque sweep",
        "torque_amplitude": "closed sweeps of several sizes",
    }.get(vary, channel_words(vary))
