"""Convergence of the stiffnesses with finer meshes, compared with their bounds."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from flexspline.fea.types import Stiffness
from flexspline.results.figures.chart import Chart
from flexspline.results.numbers import grouped
from flexspline.results.quantities import quantity
from flexspline.results.style import ACCENT, INK, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flexspline.pipeline.analysis import RunResult
    from flexspline.pipeline.diagnosis.model.extended_backlash import ExtendedBacklash

_MARGIN = 1.5
"""The axis goes on by this factor beyond the coarsest and the finest mesh."""


def write_convergence(path: Path, stiffnesses: Mapping[str, Stiffness]) -> None:
    """Write one panel per stiffness.

    Parameters
    ----------
    stiffnesses : one or more with their mesh levels, by key of the table of quantities, e.g.
        ``K_b_Nm_per_rad``, in drawing order.
    """
    with styled():
        figure = new_figure(8.0, 3.7)
        width = 0.97 / len(stiffnesses)
        for i, (key, stiffness) in enumerate(stiffnesses.items()):
            axes = figure.add_axes((0.11 + i * width, 0.26, width - 0.15, 0.62))
            _panel(axes, key, stiffness)
            if i == 0:
                axes.set_ylabel("difference from K in %")
        figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncols=3)
        save_png(figure, path)


def _panel(axes: Axes, key: str, stiffness: Stiffness) -> None:
    entry, K = quantity(key), stiffness.K_Nm_per_rad
    dofs = [level.dofs for level in stiffness.levels]
    off = [100 * (level.K_Nm_per_rad / K - 1) for level in stiffness.levels]
    low = 100 * (stiffness.lower_Nm_per_rad / K - 1)
    high = 100 * (stiffness.upper_Nm_per_rad / K - 1)
    axes.axhspan(low, high, color=PALETTE[3], alpha=0.55, lw=0, label="bounds of K")
    axes.axhline(0, color=ACCENT, lw=1.4, label="K reported")
    axes.plot(dofs, off, "o-", color=PALETTE[0], lw=1.8, ms=7, mfc="white", mew=2, label="meshes")
    axes.set_xscale("log")
    axes.set_xlim(min(dofs) / _MARGIN, max(dofs) * _MARGIN)
    ticks = _apart(dofs)
    axes.set_xticks(ticks, [f"{d / 1000:.3g}" for d in ticks])
    axes.minorticks_off()
    bottom, top = min([*off, low]), max([*off, high])
    span = max(top - bottom, 1e-6)
    axes.set_ylim(bottom - 0.15 * span, top + 0.15 * span)
    axes.grid(True)
    axes.set_xlabel("unknowns in thousands")
    axes.set_title(f"{entry.mathtext} = {grouped(K, 0)} {entry.unit}", color=INK)


def _apart(dofs: list[int]) -> list[int]:
    """Those whose labels do not touch on the logarithmic axis, the largest among them."""
    near = (_MARGIN**2 * max(dofs) / min(dofs)) ** 0.17  # a label takes 17 % of the axis
    kept: list[int] = []
    for d in sorted(dofs, reverse=True):
        if not kept or kept[-1] / d > near:
            kept.append(d)
    return kept[::-1]


def _settling(
    run: RunResult, extended: ExtendedBacklash | None
) -> tuple[dict[str, Stiffness]] | None:
    """None where every stiffness was solved on one mesh."""
    stiffnesses = run.stiffnesses
    solved = {"K_b_Nm_per_rad": stiffnesses.K_b, "K_e_Nm_per_rad": stiffnesses.K_e}
    settling = {key: K for key, K in solved.items() if len(K.levels) > 1}
    return (settling,) if settling else None


CHART = Chart(
    write=write_convergence,
    arguments=_settling,
    caption=lambda content: (
        "Stiffness against the number of unknowns, as difference from the value reported."
    ),
    width_pct=88,
)
