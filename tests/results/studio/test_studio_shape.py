"""What the page draws of a solved meridian: fewer edges, the same picture."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest
from read_arrays import read_arrays

from flexspline.geometry.load import design_from
from flexspline.geometry.template import template
from flexspline.pipeline.fast_model import field
from flexspline.pipeline.revolved import revolved
from flexspline.pipeline.stress_limits import StressCase
from flexspline.results.studio.shape import field_message
from flexspline.results.studio.simplify import simplified


def ring(count: int) -> np.ndarray:
    """A closed chain of edges."""
    return np.column_stack([np.arange(count), (np.arange(count) + 1) % count])


def test_a_square_keeps_its_corners_alone() -> None:
    side = np.linspace(0, 10, 20, endpoint=False)
    none, all_ = np.zeros(20), np.full(20, 10.0)
    r = np.concatenate([side, all_, 10 - side, none])
    z = np.concatenate([none, side, all_, 10 - side])
    kept = simplified(ring(80), np.column_stack([r, z]))
    assert sorted(kept[:, 0].tolist()) == [0, 20, 40, 60]
    assert sorted(kept[:, 1].tolist()) == [0, 20, 40, 60]


def test_a_colour_that_changes_is_kept_on_a_straight_side() -> None:
    place, colour = np.linspace(0, 10, 41), np.zeros(41)
    colour[20] = 5.0
    seen = np.column_stack([place, 0 * place, colour])
    open_chain = np.column_stack([np.arange(40), np.arange(1, 41)])
    assert simplified(open_chain, seen)[:, 0].tolist() == [0, 19, 20, 21]


def test_two_loops_stay_two() -> None:
    phi = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    circle = 100 * np.column_stack([np.cos(phi), np.sin(phi)])
    rim = np.concatenate([ring(60), 60 + ring(60)])
    kept = simplified(rim, np.concatenate([circle, 3 * circle]))
    assert sorted(kept[:, 0].tolist()) == sorted(kept[:, 1].tolist())
    assert ((kept < 60).all(axis=1) | (kept >= 60).all(axis=1)).all()
    # a chord over an angle a is off by R(1 - cos(a/2)) ≤ 1 at most
    for radius, part in ((100, kept[kept[:, 0] < 60]), (300, kept[kept[:, 0] >= 60])):
        assert len(part) >= np.pi / np.arccos(1 - 1 / radius) - 1


@pytest.mark.parametrize("view", ["wave_generator", "shaft_torque"])
def test_a_cup_is_drawn_with_a_fraction_of_its_edges(view: StressCase) -> None:
    design = revolved(design_from(tomllib.loads(template("cup"))))
    arrays = read_arrays(field_message(view, field(design, view)))
    rim, places = arrays["rim"], arrays["places"].astype(float)
    assert (
        len(rim) < 260
    )  # 37 000 times two triangles about the axis: drawn without a graphics card
    # Pappus: the outline turned about the axis holds the volume of the triangles turned about it
    (r0, z0), (r1, z1) = places[rim[:, 0]].T, places[rim[:, 1]].T
    outer = np.pi / 3 * ((r0 * r0 + r0 * r1 + r1 * r1) * (z1 - z0)).sum()
    a, b, c = (places[arrays["triangles"][:, i]] for i in range(3))
    area = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    inner = (2 * np.pi * area * (a + b + c)[:, 0] / 3).sum()
    assert outer == pytest.approx(inner, rel=2e-3)  # chords off by a fiftieth of the wall
