"""Less material is never stiffer: the order of K of nested bodies, in every load case."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import pytest
from example_files import EXAMPLES
from holed_designs import holed_designs

from flexspline.fea.types import Shortfall, Stiffness
from flexspline.geometry.load import load_design
from flexspline.geometry.nested import nested_bodies
from flexspline.geometry.part import Part
from flexspline.pipeline.enclosure import OF_HOLES, between, two_bodies
from flexspline.pipeline.errors import NestingError
from flexspline.pipeline.revolved import contact, lobes, torsion

FINE = 2e-4
"""At which 0.12 % between the two bodies of xb1-40 are more than their bounds."""
CHEAP = 0.02
"""Of the random designs: their bounds hold on the coarsest mesh too."""
OUT_OF_ORDER = 0.005
"""Of K: by which the cut body may be the stiffer one at ± 1 %. 0.18 % at most on 60 designs, where the holes
do nearly nothing."""
FAR_APART = load_design(EXAMPLES / "xb1-40.toml").changed(
    {
        "flexspline.wall_thickness_mm": 2.0,
        "flexspline.ring_thickness_mm": 2.0,
        "flexspline.length_mm": 14.0,
        "flexspline.diaphragm_thickness_mm": 2.0,
        "flexspline.boss_thickness_mm": 2.0,
        "flexspline.bolt_count": 2,
        "flexspline.bolt_hole_diameter_mm": 4.8,
    }
)
"""A short thick cup with two large holes."""
THIN = 165
"""Number of the random design with a wall of 0.12 mm on a tube of 39 mm, lobes on its finest meshes."""
SOLVES: dict[str, Callable[[Part], Stiffness]] = {
    "K_b": lambda part: torsion(part, CHEAP),
    "K_b_lobes": lambda part: lobes(part, True, CHEAP),
    "K_b_lobes_unsupported": lambda part: lobes(part, False, CHEAP),
    "K_b_lobes_contact": lambda part: contact(part, CHEAP),
}


FROM_SOFT_TO_STIFF = ("K_b_lobes_unsupported", "K_b_lobes_contact", "K_b_lobes")
"""What a free rim can do a resting one cannot, and that can do more than one that is held."""


@pytest.mark.parametrize(
    ("number", "cases"),
    [
        pytest.param(4, [name for name in SOLVES if name != "K_b_lobes_contact"], id="4"),
        pytest.param(200, list(SOLVES), id="200, lift-off too", marks=pytest.mark.long),
    ],
)
def test_nested_bodies_are_in_order(number: int, cases: list[str]) -> None:
    """Each body's own K and bounds, before anything is made of them."""
    for design in holed_designs(number):
        bodies = nested_bodies(design.part("flexspline"))
        K = {}
        for name in cases:
            cut, whole = (SOLVES[name](body) for body in (bodies.cut, bodies.whole))
            assert cut.lower_Nm_per_rad <= whole.upper_Nm_per_rad, (design.name, name)
            assert cut.K_Nm_per_rad <= whole.K_Nm_per_rad * (1 + OUT_OF_ORDER), (design.name, name)
            found = K[name] = between(cut, whole, OF_HOLES)
            assert 0 < found.lower_Nm_per_rad <= found.K_Nm_per_rad <= found.upper_Nm_per_rad
            assert found.guaranteed == (name == "K_b")
        for softer, stiffer in pairwise(name for name in FROM_SOFT_TO_STIFF if name in K):
            assert K[softer].lower_Nm_per_rad <= K[stiffer].upper_Nm_per_rad


@pytest.mark.parametrize("case", SOLVES)
def test_the_other_way_round_is_an_error_in_every_case(case: str) -> None:
    """Estimates too: the two are 16 to 30 % apart, and each is known to ± 0.8 % at worst."""
    bodies = nested_bodies(FAR_APART.part("flexspline"))
    cut, whole = SOLVES[case](bodies.cut), SOLVES[case](bodies.whole)
    found = between(cut, whole, OF_HOLES)
    assert found.bounds_Nm_per_rad == (cut.lower_Nm_per_rad, whole.upper_Nm_per_rad)
    with pytest.raises(NestingError, match="one of the two solutions is wrong"):
        between(whole, cut, OF_HOLES)


@pytest.mark.parametrize(
    ("cut_K", "whole_guaranteed", "refused"),
    [
        (1010.0, False, False),  # ± 10 and ± 10: ends at 1000 and 1010
        (1039.0, False, False),  # they cross by 19, and 20 is allowed
        (1041.0, False, True),
        (1021.0, True, True),  # theorems may not cross at all
        (1019.0, True, False),
    ],
)
def test_estimates_may_cross_by_both_half_widths(
    cut_K: float, whole_guaranteed: bool, refused: bool
) -> None:
    whole = known(1000.0, whole_guaranteed)
    cut = known(cut_K, whole_guaranteed)
    if refused:
        with pytest.raises(NestingError):
            between(cut, whole, OF_HOLES)
    else:
        found = between(cut, whole, OF_HOLES)
        assert found.bounds_Nm_per_rad == tuple(sorted((cut_K - 10.0, 1010.0)))
        assert "differ by less than the bounds of either" in found.method


def known(K: float, guaranteed: bool) -> Stiffness:
    """To ± 10 N·m/rad."""
    return Stiffness(K, K - 10, K + 10, guaranteed, "axisymmetric", "", "", ())


def test_the_other_way_round_is_an_error() -> None:
    bodies = nested_bodies(load_design(EXAMPLES / "xb1-40.toml").part("flexspline"))
    cut, whole = torsion(bodies.cut, FINE), torsion(bodies.whole, FINE)
    with pytest.raises(NestingError) as caught:
        between(whole, cut, OF_HOLES)
    assert caught.value.softer_Nm_per_rad == whole.lower_Nm_per_rad
    assert caught.value.stiffer_Nm_per_rad == cut.upper_Nm_per_rad


def test_the_bounds_are_theorems_where_both_bodies_are() -> None:
    bodies = nested_bodies(load_design(EXAMPLES / "xb1-40.toml").part("flexspline"))
    cut, whole = torsion(bodies.cut, CHEAP), torsion(bodies.whole, CHEAP)
    assert between(cut, whole, OF_HOLES).guaranteed
    assert not between(replace(cut, guaranteed=False), whole, OF_HOLES).guaranteed
    assert not between(cut, replace(whole, guaranteed=False), OF_HOLES).guaranteed


def test_what_fell_short_is_said() -> None:
    bodies = nested_bodies(load_design(EXAMPLES / "xb1-40.toml").part("flexspline"))
    cut, whole = torsion(bodies.cut, CHEAP), torsion(bodies.whole, CHEAP)
    short = Shortfall("no time")
    assert between(replace(cut, shortfall=short), whole, OF_HOLES).shortfall == short
    assert between(cut, replace(whole, shortfall=short), OF_HOLES).shortfall == short
    assert not between(cut, whole, OF_HOLES).shortfall


@pytest.mark.long
def test_a_long_thin_tube_is_loaded_too() -> None:
    """A wall of 1/300 of the diameter, on which scikit-fem's search for points on an edge gives up."""
    design = holed_designs(THIN + 1)[THIN]
    assert design.flexspline.inner_diameter_mm > 300 * design.flexspline.wall_thickness_mm
    found = two_bodies(design.part("flexspline"), SOLVES["K_b_lobes_contact"]).enclosure()
    assert found.half_width < 2 * CHEAP
