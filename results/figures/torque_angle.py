"""The model's torque-angle line: two elastic branches, the gap between them, its uncertainty."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flexspline.pipeline.backlash import ARCSEC_PER_RAD, Backlash, angle_rad
from flexspline.results.figures.chart import Chart
from flexspline.results.figures.fitted_text import GROUND, angle_title, keep_inside, torque_title
from flexspline.results.quantities import quantity
from flexspline.results.style import ACCENT, INK, MUTED, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flexspline.pipeline.analysis import RunResult
    from flexspline.pipeline.diagnosis.model.extended_backlash import ExtendedBacklash

DRAWN_RATIO = 1.25
"""How far beyond ±T_L the line is drawn."""


def drawn_branch(
    angle_arcsec: Callable[[np.ndarray], np.ndarray], torque_Nm: float
) -> tuple[np.ndarray, np.ndarray]:
    """Torques [N·m] above 0 that are drawn at a load of `torque_Nm`, and the line at them [arcsec]."""
    torque = np.linspace(1e-6, DRAWN_RATIO, 60) * torque_Nm
    return torque, angle_arcsec(torque)


def write_torque_angle(
    path: Path, branch: tuple[np.ndarray, np.ndarray], torque_Nm: float, backlash: Backlash
) -> None:
    """Write the chart of θ(T) with T_L, the gap and the lost motion.

    Parameters
    ----------
    branch : `drawn_branch` of the model's line, which is odd.
    torque_Nm : T_L.
    backlash : its terms set the gap and the 1σ band; its total is the lost motion drawn.
    """
    with styled():
        figure = new_figure(8.0, 4.6)
        axes = figure.add_axes((0.095, 0.125, 0.875, 0.775))
        for sign in (-1.0, 1.0):
            t, angle = sign * branch[0], sign * branch[1]
            spread = band(t, torque_Nm, backlash)
            axes.fill_between(
                t, angle - spread, angle + spread, color=PALETTE[1], alpha=0.22, lw=0,
                label="1σ" if sign > 0 and backlash.std_arcsec is not None else None,
            )  # fmt: skip
            axes.plot(
                t, angle, color=PALETTE[0], lw=2.4, solid_capstyle="round",
                label="model" if sign > 0 else None,
            )  # fmt: skip
        _annotate(axes, branch, torque_Nm, backlash)
        keep_inside(axes)
        save_png(figure, path)


def band(torque: np.ndarray, load_Nm: float, backlash: Backlash) -> np.ndarray:
    """1σ of the angle [arcsec] at each torque: half the backlash's, the elastic part as |T|/T_L."""
    parts = backlash.std_by_source_arcsec
    elastic = parts.get("youngs_modulus", 0.0)
    gap = np.sqrt(sum(v**2 for name, v in parts.items() if name != "youngs_modulus"))
    return np.hypot(gap, elastic * np.abs(torque) / load_Nm) / 2


def _annotate(
    axes: Axes, branch: tuple[np.ndarray, np.ndarray], load: float, backlash: Backlash
) -> None:
    high = float(np.interp(load, *branch))
    low = -high
    gap = backlash.gap_arcsec
    arcsec = quantity("backlash_arcsec.total")
    end = np.array([DRAWN_RATIO * load])
    highest = float(branch[1][-1])
    top = max(1.35 * highest, 1.08 * (highest + float(band(end, load, backlash)[0])))
    axes.plot([0, 0], [-gap / 2, gap / 2], color=PALETTE[0], lw=2.4, ls=(0, (1.5, 1.5)))
    axes.axhline(0, color=MUTED, lw=0.8)
    for t, angle, words, side in ((-load, low, "−T", 1), (load, high, "+T", -1)):
        axes.plot([t, t], [-top, angle], color=MUTED, lw=0.8, ls=(0, (4, 3)))
        axes.plot([t], [angle], "o", ms=7, mfc="white", mec=PALETTE[0], mew=2)
        axes.annotate(
            f"{words}$_{{\\mathrm{{L}}}}$ = {'−' if t < 0 else ''}{load:.4g} N·m",
            (t, -top),
            (5 * side, 6),
            textcoords="offset points",
            ha="left" if side > 0 else "right",
            color=INK,
        )
    axes.plot([-load, 1.16 * load], [low, low], color=MUTED, lw=0.8, ls=(0, (4, 3)))
    axes.plot([load, 1.16 * load], [high, high], color=MUTED, lw=0.8, ls=(0, (4, 3)))
    _span(axes, 1.13 * load, low, high)
    axes.annotate(
        f"backlash\n{_total(backlash)} {arcsec.unit}",
        (0.97 * load, 0),
        (0, -24),
        textcoords="offset points",
        ha="right",
        va="center",
        weight="bold",
        bbox=GROUND,
    )
    _span(axes, -0.09 * load, -gap / 2, gap / 2)
    axes.annotate(
        f"gap {arcsec.short(gap)} {arcsec.unit}",
        (-0.09 * load, 0),
        (-8, 14),
        textcoords="offset points",
        ha="right",
        va="center",
        bbox=GROUND,
    )
    axes.set_xlim(-DRAWN_RATIO * load, DRAWN_RATIO * load)
    axes.set_ylim(-top, top)
    axes.grid(True)
    axes.set_xlabel(torque_title("output torque T"))
    axes.set_ylabel(angle_title("output angle θ"))
    axes.set_title("Angle at the output, wave generator locked")
    axes.legend(loc="upper left", ncols=2)


def _total(backlash: Backlash) -> str:
    arcsec, std = quantity("backlash_arcsec.total"), backlash.std_arcsec
    spread = "" if std is None else f" ± {arcsec.short(std)}"
    return f"{arcsec.short(backlash.total_arcsec)}{spread}"


def _span(axes: Axes, x: float, low: float, high: float) -> None:
    axes.annotate(
        "",
        (x, high),
        (x, low),
        arrowprops={
            "arrowstyle": "<|-|>",
            "color": ACCENT,
            "lw": 1.5,
            "shrinkA": 0,
            "shrinkB": 0,
            "mutation_scale": 13,
        },
    )


def _of_run(run: RunResult, extended: ExtendedBacklash | None) -> tuple[Any, ...]:
    design, stiffnesses = run.design, run.stiffnesses
    K_b, K_e = stiffnesses.in_sum(design).K_Nm_per_rad, stiffnesses.K_e.K_Nm_per_rad

    def angle(torque: np.ndarray) -> np.ndarray:
        return np.asarray(angle_rad(design, torque, K_b, K_e)) * ARCSEC_PER_RAD

    load = design.load.torque_Nm
    return drawn_branch(angle, load), load, run.backlash


CHART = Chart(
    write=write_torque_angle,
    arguments=_of_run,
    caption=lambda content: (
        "The torque–angle line of the model. Within the gap the angle is not determined."
    ),
    width_pct=54,
)
