"""Whether a peak is the part's or the stress rule's: fields by hand, and parts whose answer is known."""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
import pytest
from axisymmetric_shapes import tube
from example_cup import CUP
from example_files import EXAMPLES

from flexspline.fea.axisymmetric.stress import ellipse_stress, torsion_stress
from flexspline.fea.stress_rule import judged
from flexspline.fea.types import Elastic, StressPeak
from flexspline.geometry.keys import with_values
from flexspline.geometry.load import load_design
from flexspline.pipeline.study.evaluate import figures_of

STEEL = Elastic(206e3, 0.3)
FAR = 0.5
"""mm."""


def judged_by(stress, most: float = 10.0) -> StressPeak:
    """The largest stress FAR from an edge, where it is `stress` of the distance, up to `most` mm."""
    places = np.linspace(0.01, most, 20001)
    values = np.array([stress(d) for d in places])
    top = values[places >= FAR].max()
    at = places[(places >= FAR) & (values == top)][0]

    def largest(distance_mm: float, within_mm: float = inf) -> float | None:
        found = values[(places >= distance_mm) & (np.abs(places - at) <= within_mm)]
        return float(found.max()) if len(found) else None

    return judged(float(top), (0.0, 0.0, 0.0), FAR, largest)


def test_a_crack_like_edge_gives_a_peak_of_the_rule(record) -> None:
    peak = judged_by(lambda d: 100 / sqrt(d))
    assert peak.at_excluded_border
    fall = peak.mises_at_twice_MPa / peak.mises_MPa
    record("stress that falls as 1/√d: at twice the distance left out", "1/√2", 1 / sqrt(2), fall)
    # the places are 0.5 µm apart: 1e-3 of FAR, so 5e-4 of a stress that falls as 1/√d
    assert peak.mises_at_twice_MPa == pytest.approx(peak.mises_MPa / sqrt(2), rel=1e-3)
    assert peak.exclusion_mm == FAR


@pytest.mark.parametrize(
    ("what", "stress"),
    [
        ("even stress", lambda d: 100.0),
        ("a hill beside the border", lambda d: 100 - 50 * (d - 1.1 * FAR) ** 2 / FAR**2),
        (
            "a solid mesh near the border",
            lambda d: 100 - 4.4 * min(d / FAR, 1) - 25 * max(d / FAR - 1, 0),
        ),
        ("a hill far from a weak edge", lambda d: 60 / sqrt(d) + 200 * (abs(d - 3) < 0.1)),
    ],
)
def test_a_maximum_of_the_part_is_no_peak_of_the_rule(what: str, stress) -> None:
    assert not judged_by(stress).at_excluded_border, what


def test_no_point_twice_as_far() -> None:
    peak = judged_by(lambda d: 100 / sqrt(d), most=0.8)
    assert peak.mises_at_twice_MPa is None
    assert peak.at_excluded_border


def test_a_load_scales_both_figures() -> None:
    peak = judged_by(lambda d: 100 / sqrt(d))
    twice = peak.times(2.0)
    assert (twice.mises_MPa, twice.mises_at_twice_MPa) == pytest.approx(
        (2 * peak.mises_MPa, 2 * peak.mises_at_twice_MPa)
    )


def test_a_tubes_even_stress_is_its_own_wherever_it_is_found() -> None:
    """Coulomb: the same all along the outside, so the distance left out does not matter."""
    peak = torsion_stress(tube(5, 8, 30), STEEL, "grip", 2.0, 1.0, 1e-3).peak
    assert not peak.at_excluded_border
    assert peak.mises_at_twice_MPa == pytest.approx(peak.mises_MPa, rel=1e-3)


def test_the_edge_of_the_seat_is_singular() -> None:
    """A rigid seat that ends on a smooth wall: the stress rises towards its end without bound."""
    wall = CUP.wall_thickness_mm
    near, far = (
        ellipse_stress(CUP.meridian(), STEEL, 0.2, apart, 0.005).peak for apart in (wall, 2 * wall)
    )
    assert near.at_excluded_border
    assert near.mises_MPa > 1.1 * far.mises_MPa
    # the same field looked at twice as far, on a mesh refined for the nearer figure
    assert near.mises_at_twice_MPa == pytest.approx(far.mises_MPa, rel=0.01)


def test_the_shafts_peak_stands_still_while_the_flexsplines_wall_moves() -> None:
    design = load_design(EXAMPLES / "xb1-40.toml")
    found = [
        figures_of(with_values(design, {"flexspline.wall_thickness_mm": wall}), ("torque",)).figures
        for wall in (0.25, 0.45, 0.55)
    ]
    first, *others = (f["shaft_torque_peak_mises_MPa"] for f in found)
    assert others == [first, first]  # the same shaft, the same question
    assert [f["shaft_torque_peak_at_excluded_border"] for f in found] == [0.0, 0.0, 0.0]
    assert [f["torque_peak_at_excluded_border"] for f in found] == [1.0, 1.0, 1.0]
