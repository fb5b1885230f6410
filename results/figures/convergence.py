"""How the stiffnesses settle as their meshes get finer, against their bounds."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from fea.types import Stiffness
from results.quantities import grouped, quantity
from results.style import ACCENT, INK, PALETTE, new_figure, save_png, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def write_convergence(path: Path, stiffnesses: Mapping[str, Stiffness]) -> None:
    """Write one panel per stiffness that has mesh levels.

    Parameters
    ----------
    stiffnesses : by key of the table of quantities, e.g. ``K_b_Nm_per_rad``, in drawing order.
    """
    drawn = {key: s for key, s in stiffnesses.items() if s.levels}
    with styled():
        figure = new_figure(8.0, 3.4)
        width = 0.97 / max(1, len(drawn))
        for i, (key, stiffness) in enumerate(drawn.items()):
            axes = figure.add_axes((0.09 + i * width, 0.17, width - 0.13, 0.68))
            _panel(axes, key, stiffness)
            if i == 0:
                axes.set_ylabel("difference from K in %")
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
    ends = (min(dofs) / 1.5, max(dofs) * 1.5)
    axes.set_xlim(*ends)
    ticks = _apart(dofs)
    axes.set_xticks(ticks, [f"{d / 1000:.3g}" for d in ticks])
    axes.minorticks_off()
    bottom, top = min([*off, low]), max([*off, high])
    span = max(top - bottom, 1e-6)
    axes.set_ylim(bottom - 0.15 * span, top + 0.45 * span)
    axes.grid(True)
    axes.set_xlabel("unknowns in thousands")
    axes.set_title(f"{entry.mathtext} = {grouped(K, 0)} {entry.unit}", color=INK)
    axes.legend(loc="upper right", fontsize=9)


def _apart(dofs: list[int]) -> list[int]:
    """Those whose labels do not touch on the logarithmic axis, the largest among them."""
    near = max((max(dofs) / min(dofs)) ** 0.18, 1.05)
    kept: list[int] = []
    for d in sorted(dofs, reverse=True):
        if not kept or kept[-1] / d > near:
            kept.append(d)
    return kept[::-1]
