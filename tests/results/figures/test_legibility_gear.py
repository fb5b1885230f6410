"""The whole gear's charts can be read, whatever gear they show."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hand_made_curve import gear_curve
from legibility import drawn_figures, faults

from flexspline.pipeline.gear.gear_remarks import LoadedLastPair
from flexspline.results.figures.gear_loads import write_gear_loads
from flexspline.results.figures.gear_torque_angle import write_gear_angle

CURVES = {
    "usual": gear_curve(23.2, 474.0, 108.0),
    "huge": gear_curve(9.6e5, 2.1e-3, 4.4e7),
    "tiny": gear_curve(1.3e-7, 8.8e4, 3e-6),
    "straight": gear_curve(52.0, 600.0, 300.0, softening=1.0),
    "a gap first": gear_curve(31.0, 400.0, 200.0, softening=0.05),
    "a loaded last pair": replace(
        gear_curve(195.0, 474.0, 108.0),
        tooth_angle_deg=tuple(1.5 * k for k in range(-36, 37)),
        tooth_force_N=(*(50.0,) * 72, 415.0),
        notes=(LoadedLastPair(54.0),),
    ),
}


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("write", [write_gear_angle, write_gear_loads])
def test_gear_charts(tmp_path: Path, name: str, write) -> None:
    with drawn_figures() as found:
        write(tmp_path / "a.png", CURVES[name])
    (figure,) = found
    assert faults(figure) == []


def test_the_tallest_bars_are_named_with_force_and_place(tmp_path: Path) -> None:
    curve = replace(
        CURVES["usual"],
        tooth_angle_deg=(-6.0, 0.0, 6.0),
        tooth_force_N=(1.0, 2.0, 41.0),
        ball_angle_deg=(0.0, 90.0, 150.0),  # 150° is −30° of the other lobe
        ball_force_N=(10.0, 5.0, 77.0),
    )
    with drawn_figures() as found:
        write_gear_loads(tmp_path / "a.png", curve)
    said = [text.get_text() for axes in found[0].axes for text in axes.texts]
    assert said == ["largest: 41 N at 6°", "largest: 77 N at −30°"]


def test_a_bar_is_said_to_be_a_station_and_not_a_tooth(tmp_path: Path) -> None:
    curve = replace(
        CURVES["usual"], tooth_angle_deg=(-6.0, 0.0, 6.0), tooth_force_N=(1.0, 2.0, 41.0)
    )
    with drawn_figures() as found:
        write_gear_loads(tmp_path / "a.png", curve)
    assert (
        found[0]
        .axes[0]
        .get_xlabel()
        .startswith("One bar for each station of the model, 6.00° apart")
    )


@pytest.mark.parametrize("tallest", [-84.0, 0.0, 84.0])
def test_no_word_stands_among_the_bars(tmp_path: Path, tallest: float) -> None:
    at = (-84.0, -40.0, 0.0, 40.0, 84.0)
    force = tuple(99.0 if a == tallest else 98.0 for a in at)
    curve = replace(
        CURVES["usual"],
        tooth_angle_deg=at,
        tooth_force_N=force,
        ball_angle_deg=at,
        ball_force_N=force,
    )
    with drawn_figures() as found:
        write_gear_loads(tmp_path / "a.png", curve)
        renderer = found[0].canvas.get_renderer()
        for axes in found[0].axes:
            inside = axes.get_window_extent(renderer)
            assert not any(inside.overlaps(t.get_window_extent(renderer)) for t in axes.texts)
