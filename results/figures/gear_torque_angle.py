"""The whole gear's torque-angle curve with the catalogue's three slopes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from flexspline.pipeline.gear.gear_curve import GearCurve
from flexspline.results.figures.chart import Chart
from flexspline.results.figures.fitted_text import angle_title, torque_title
from flexspline.results.quantities import quantity
from flexspline.results.style import ACCENT, MUTED, PALETTE, new_figure, save_png, styled


def write_gear_angle(path: Path, curve: GearCurve) -> None:
    """θ(T) with K1, K2 and K3, the chords between the torques that are marked."""
    torque, angle = np.array(curve.torque_Nm), np.array(curve.angle_arcsec)
    with styled():
        figure = new_figure(8.0, 4.6)
        axes = figure.add_axes((0.13, 0.13, 0.84, 0.77))
        axes.axhline(0, color=MUTED, lw=0.8)
        axes.axvline(0, color=MUTED, lw=0.8)
        axes.plot(torque, angle, color=PALETTE[0], lw=2.2)
        for end, key in (
            (curve.T1_Nm, "T1"),
            (curve.T2_Nm, "T2"),
            (curve.rated_torque_Nm, "rated"),
        ):
            at = float(np.interp(end, *_rising(torque, angle)))
            axes.plot([end], [at], "o", color=ACCENT, ms=5)
            axes.annotate(key, (end, at), xytext=(-4, 6), textcoords="offset points", ha="right")
        words = "\n".join(
            f"{name} {quantity(f'{name}_Nm_per_rad').with_unit(getattr(curve, f'{name}_Nm_per_rad'))}"
            for name in ("K1", "K2", "K3")
        )
        axes.text(0.97, 0.06, words, transform=axes.transAxes, ha="right", va="bottom")
        axes.set_title("Whole gear, wave generator locked")
        axes.set_xlabel(torque_title("Torque"))
        axes.set_ylabel(angle_title("Angle"))
        axes.margins(y=0.12)  # "rated" stands above the curve's end
        axes.grid(True)
        save_png(figure, path)


def _rising(torque: np.ndarray, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The first branch, 0 to rated torque."""
    last = int(torque.argmax()) + 1
    return torque[:last], angle[:last]


CHART = Chart(
    write=write_gear_angle,
    arguments=lambda run, extended: None if run.gear is None else (run.gear,),
    caption=lambda content: (
        "Angle of the output over torque, and the torques between which the slopes are taken."
    ),
    width_pct=66,
)
