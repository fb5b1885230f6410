"""dK/dp in two ways, and against what scaling says."""

from dataclasses import replace
from functools import cache
from itertools import groupby
from pathlib import Path

import pytest
from example_files import EXAMPLES

from flexspline.fea.axisymmetric.shape_slope import moved_stiffness
from flexspline.fea.axisymmetric.surface_layer import HeldSurfaceError, layer_stiffness
from flexspline.fea.axisymmetric.twist import Twist, twist
from flexspline.fea.errors import MemoryShortError
from flexspline.fea.types import Elastic, Shortfall
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.keys import with_values, without_holes
from flexspline.geometry.load import load_design
from flexspline.pipeline.backlash import ARCSEC_PER_RAD, windup
from flexspline.pipeline.revolved import lobes, revolved, torsion
from flexspline.pipeline.study import stiffness_slopes
from flexspline.pipeline.study.sensitivity import sensitivities
from flexspline.pipeline.study.slope import Slope, Slopes
from flexspline.pipeline.study.stiffness_slopes import slope_with_field_held
from flexspline.results.study.sensitivity import lines, record


@cache
def slopes_of(name: str) -> tuple[Slope, ...]:
    return sensitivities(load_design(EXAMPLES / f"{name}.toml"), lambda line: None)


@pytest.mark.long
@pytest.mark.parametrize("name", ["keyed-shaft", "hat-25"])
def test_both_ways_meet_and_scaling_holds(name: str) -> None:
    """K is proportional to the cube of all lengths together, so Σ p·dK/dp = 3K (Euler).

    The cup is asked by the command (`tests/results/study/test_study_command.py`).
    """
    slopes = slopes_of(name)
    assert [(s.key, s.why.words) for s in slopes if s.agree is not True] == []
    for part, own in groupby(slopes, lambda s: s.part):
        total = sum(s.elasticity for s in own)
        # the solved field's K is up to 0.1 % high and its slopes with it
        assert total == pytest.approx(3.0, abs=0.01), part


@pytest.mark.parametrize("load_case", ["uniform", pytest.param("lobes", marks=pytest.mark.long)])
def test_the_sum_follows_its_own_stiffness(load_case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Differences of the sum's term over a step ten times as long, by the K of the sum's load case."""
    key, step = "flexspline.ring_thickness_mm", 0.05
    design = revolved(load_design(EXAMPLES / "xb1-40.toml"))
    design = design.changed({"solver.load_case": load_case})
    here = design.flexspline.ring_thickness_mm

    def term(thickness: float) -> float:
        part = design.changed({key: thickness}).part("flexspline")
        K = lobes(part, True, 1e-3) if load_case == "lobes" else torsion(part, 1e-4)
        return ARCSEC_PER_RAD * windup(design.load.torque_Nm, K.K_Nm_per_rad)

    monkeypatch.setattr(
        stiffness_slopes, "lengths", lambda part: {key: here} if part.name == "flexspline" else {}
    )
    (found,) = stiffness_slopes.slopes(design, lambda _: None).slopes
    expected = (term(here + step) - term(here - step)) / (2 * step)
    # its bend over ± 0.05 mm, and K known to 2e-4 of some 30 arcsec over 0.1 mm
    assert found.backlash_arcsec_per_mm == pytest.approx(expected, rel=0.1, abs=0.06)


def test_a_sum_without_a_slope_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    """The lobes fail, for want of memory; K's own slope stays."""
    design = load_design(EXAMPLES / "xb1-40.toml").changed({"solver.load_case": "lobes"})
    key = "flexspline.ring_thickness_mm"

    def short(*_: object) -> None:
        raise MemoryShortError(1000, 9e9, 1e9)

    monkeypatch.setattr(stiffness_slopes, "lobes", short)
    monkeypatch.setattr(
        stiffness_slopes, "lengths", lambda part: {key: 0.55} if part.name == "flexspline" else {}
    )
    (found,) = stiffness_slopes.slopes(design, lambda _: None).slopes
    assert found.agree
    assert found.backlash_arcsec_per_mm is None
    assert found.why_no_sum.of_the_machine
    said = record(design, [found])["sensitivity"][0]
    assert said["no_backlash_because"] == found.why_no_sum.words
    assert any(found.why_no_sum.words in line for line in lines(design, [found]))


@pytest.fixture(scope="module")
def shaft() -> tuple[Design, Twist]:
    """The example's shaft without holes, whose bore is one line, turned."""
    plain = without_holes(load_design(EXAMPLES / "xb1-40.toml"))
    material = Elastic.of(plain.part("shaft").material)
    return plain, twist(plain.part("shaft").meridian, material, "grip", 1e-3)


BORES = "shaft.segment[0].inner_diameter_mm", "shaft.segment[1].inner_diameter_mm"


def test_a_layer_adds_what_a_mesh_that_follows_adds(shaft: tuple[Design, Twist]) -> None:
    """Both bores at once keep the corners: volume and surface give one derivative."""
    design, solved = shaft
    wider = with_values(design, dict.fromkeys(BORES, 6.01)).part("shaft").meridian
    followed = moved_stiffness(solved, wider) - solved.K_Nm_per_rad
    # the surface takes the strain of an energy that is known to 1e-3, thus to its root, 3 %
    assert layer_stiffness(solved, wider) == pytest.approx(followed, rel=0.03)


def test_layers_of_each_bore_add_up(shaft: tuple[Design, Twist]) -> None:
    """Each alone is a step; edges cut by the step's place count by points, of which each has 16."""
    design, solved = shaft
    one, two, both = (
        layer_stiffness(
            solved, with_values(design, dict.fromkeys(keys, 6.01)).part("shaft").meridian
        )
        for keys in (BORES[:1], BORES[1:], BORES)
    )
    assert one + two == pytest.approx(both, rel=0.02)


def test_a_surface_that_is_turned_has_no_layer(shaft: tuple[Design, Twist]) -> None:
    design, solved = shaft
    thicker = with_values(design, {"shaft.segment[1].outer_diameter_mm": 18.01})
    with pytest.raises(HeldSurfaceError) as caught:
        layer_stiffness(solved, thicker.part("shaft").meridian)
    assert caught.value.patch == "grip"
    assert caught.value.by_mm == pytest.approx(0.005)


@pytest.mark.parametrize("barred", [(), (1,), (-1,)])
def test_one_side_does_where_the_other_cannot_be_built(barred: tuple[int, ...]) -> None:
    def K(values: dict[str, float]) -> float:
        p = values.get("p", 2.0)
        if (p > 2.0 and 1 in barred) or (p < 2.0 and -1 in barred):
            raise DesignError("p", p, "does not fit")
        return p**3

    # one-sided: off by half the second derivative times the step, 6 · 2e-4
    assert slope_with_field_held(K, "p", 2.0) == pytest.approx(12.0, abs=2e-3)


DESIGN = load_design(EXAMPLES / "xb1-40.toml")
FOUND = (
    Slope("shaft.fillet_mm", "shaft", 0.5, 447.6, None, 0.0, 43275.0, -0.046, Shortfall("no room")),
)


@pytest.fixture
def solves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Design]:
    """The designs whose slopes are solved, each with the same answer, on an empty cache."""
    asked: list[Design] = []
    monkeypatch.setenv("FLEXSPLINE_CACHE", str(tmp_path))
    monkeypatch.setattr(
        stiffness_slopes,
        "slopes",
        lambda design, say: (
            asked.append(design) or Slopes(FOUND, {"shaft.grip_length_mm": Shortfall("none")})
        ),
    )
    return asked


def test_slopes_are_solved_once_and_missing_ones_said_again(solves: list[Design]) -> None:
    for _ in range(2):
        said: list[str] = []
        assert sensitivities(DESIGN, said.append) == FOUND
        assert said == ["no dK/dp of shaft.grip_length_mm: none"]
    assert len(solves) == 1


@pytest.mark.parametrize(
    ("key", "value", "again"),
    [("name", "another", False), ("load.torque_Nm", 0.7, True), ("shaft.fillet_mm", 0.6, True)],
)
def test_slopes_are_solved_again_where_they_may_change(
    key: str, value: object, again: bool, solves: list[Design]
) -> None:
    for design in (DESIGN, with_values(DESIGN, {key: value})):
        sensitivities(design, lambda line: None)
    assert len(solves) == 1 + again


def test_what_more_memory_would_find_is_not_kept(
    solves: list[Design], monkeypatch: pytest.MonkeyPatch
) -> None:
    short = Slopes((), {"shaft.fillet_mm": Shortfall("not enough memory", of_the_machine=True)})
    monkeypatch.setattr(stiffness_slopes, "slopes", lambda design, say: short)
    assert sensitivities(DESIGN, lambda line: None) == ()
    part = replace(FOUND[0], why_no_sum=next(iter(short.missing.values())))
    monkeypatch.setattr(stiffness_slopes, "slopes", lambda design, say: Slopes((part,), {}))
    assert sensitivities(DESIGN, lambda line: None) == (part,)
    monkeypatch.setattr(stiffness_slopes, "slopes", lambda design, say: Slopes(FOUND, {}))
    assert sensitivities(DESIGN, lambda line: None) == FOUND
