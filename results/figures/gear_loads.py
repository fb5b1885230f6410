"""Loads over the whole gear's teeth and balls."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from flexspline.geometry.errors import plain_number
from flexspline.pipeline.gear.gear_curve import GearCurve
from flexspline.pipeline.gear.gear_remarks import LoadedLastPair
from flexspline.results.figures.chart import Chart
from flexspline.results.numbers import grouped
from flexspline.results.quantities import quantity
from flexspline.results.style import PALETTE, new_figure, save_png, styled


def write_gear_loads(path: Path, curve: GearCurve) -> None:
    """Forces of teeth and balls over the angle from the major axis, at rated torque, one lobe."""
    ball_angle = (np.array(curve.ball_angle_deg) + 90) % 180 - 90  # one half turn about the lobe
    with styled():
        figure = new_figure(8.0, 5.2)
        teeth, balls = np.array(curve.tooth_angle_deg), ball_angle
        forces = (
            ("pair of teeth", teeth, np.array(curve.tooth_force_N), 1.2, _stations(teeth)),
            ("ball", balls, np.array(curve.ball_force_N), 5.0, ""),
        )
        newton = quantity("preload_tooth_force_N").unit
        last = any(isinstance(note, LoadedLastPair) for note in curve.notes)
        for i, (what, angle, force, width, where) in enumerate(forces):
            axes = figure.add_axes((0.11, 0.61 - 0.49 * i, 0.86, 0.29))
            edge = angle == -90  # the same ball stands at 90°
            angle, force = np.append(angle, -angle[edge]), np.append(force, force[edge])
            axes.bar(angle, force, width=width, color=PALETTE[i], edgecolor="none")
            axes.set_title(f"Force of a {what} in {newton}")
            axes.set_xlabel(where)
            most = int(np.abs(force).argmax())
            words = (
                f"largest: {plain_number(force[most], 3)} {newton} at {grouped(angle[most], 0)}°"
            )
            if last and i == 0 and most in (0, len(teeth) - 1):
                words += ", last pair in the working depth"
            axes.annotate(  # beside the title, where no bar and no line is
                words, (1.0, 1.0), xycoords="axes fraction", xytext=(0, 6), textcoords="offset points",
                ha="right",
            )  # fmt: skip
            axes.set_xlim(-93, 93)
            axes.set_xticks(range(-90, 91, 30))
            axes.grid(True, axis="y")
        axes.set_xlabel(
            "Angle from the major axis in degrees. Rated torque; the other half turn is equal"
        )
        save_png(figure, path)


def _stations(angle_deg: np.ndarray) -> str:
    """Where forces are solved: the model's stations are not the teeth themselves."""
    if len(angle_deg) < 2:
        return ""
    spacing = np.diff(angle_deg).mean()
    return f"One bar for each station of the model, {spacing:.2f}° apart: the force of a pair of teeth there"


CHART = Chart(
    write=write_gear_loads,
    arguments=lambda run, extended: None if run.gear is None else (run.gear,),
    caption=lambda content: "Forces on tooth pairs and balls at rated torque, around one lobe.",
    width_pct=66,
)
