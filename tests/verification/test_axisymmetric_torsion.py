"""Torsion of bodies of revolution against closed forms; the bounds against their promise."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from axisymmetric_shapes import MODEL_CUP, annular_plate, cups, hats, outline, shafts, tube
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flexspline.fea.axisymmetric.bisection import refined
from flexspline.fea.axisymmetric.patches import PatchError, sorted_boundary
from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.axisymmetric.torsion_fields import bracket
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.types import NMM_PER_NM, Elastic
from flexspline.geometry.outline import Meridian
from flexspline.geometry.shaft_shape import Shaft, ShaftSegment

STEEL = Elastic(200e3, 0.3)
ROUNDING = 1e-9
"""Bounds that a closed form attains exactly differ from it by rounding of sums over elements."""


def everywhere(mesh):
    return refined(mesh, np.ones(len(mesh.triangles), bool))


def assert_encloses(found, exact: float, tolerance: float) -> None:
    assert found.lower_Nm_per_rad <= exact * (1 + ROUNDING)
    assert found.upper_Nm_per_rad >= exact * (1 - ROUNDING)
    assert found.upper_Nm_per_rad - found.lower_Nm_per_rad < tolerance * exact * 1.01


@pytest.mark.parametrize(("inner", "outer"), [(19.8, 20.2), (5.0, 20.0), (0.0, 8.5)])
def test_coulomb_tube_and_solid_shaft(inner, outer, record):
    """Coulomb 1784: K = G J/L, J = π(b⁴ - a⁴)/2. ψ is linear in z, so the upper bound is exact."""
    exact = STEEL.mu * pi * (outer**4 - inner**4) / 2 / 30 / NMM_PER_NM
    found = torsional_stiffness(tube(inner, outer, 30), STEEL, "grip", 1e-4)
    record(f"Tube {inner:g}/{outer:g} mm, K", "Coulomb 1784", exact, found.K_Nm_per_rad, "N·m/rad")
    assert_encloses(found, exact, 1e-4)
    assert found.upper_Nm_per_rad == pytest.approx(exact, rel=ROUNDING)


def test_thin_tube_formula(record):
    """Bredt: 2πG R³t/L; the next term of J is (t/2R)² = 1e-4 of it at R = 20, t = 0.4."""
    found = torsional_stiffness(tube(19.8, 20.2, 30), STEEL, "grip", 1e-5)
    thin = 2 * pi * STEEL.mu * 20**3 * 0.4 / 30 / NMM_PER_NM
    record("Thin tube, K", "2πGR³t/L (Bredt)", thin, found.K_Nm_per_rad, "N·m/rad")
    assert found.K_Nm_per_rad == pytest.approx(thin * (1 + 0.01**2), rel=1e-5)


def test_annular_plate_in_shear(record):
    """A plate turned in its plane: K = 4πG h/(1/r² - 1/R²). φ is linear in z: a lower bound all but exact."""
    exact = 4 * pi * STEEL.mu * 2 / (1 / 11**2 - 1 / 20**2) / NMM_PER_NM
    found = torsional_stiffness(annular_plate(11, 20, 2), STEEL, "grip", 1e-5)
    source = "Timoshenko and Goodier §43"
    record("Annular plate in shear, K", source, exact, found.K_Nm_per_rad, "N·m/rad")
    assert_encloses(found, exact, 1e-5)


def test_reissner_sagoci_disc_on_half_space(record):
    """Reissner and Sagoci, J. Appl. Phys. 15 (1944) 652: a bonded rigid disc, K = 16/3 G a³.

    A block of 25 a stands for the half space; its far field is a torsion dipole whose share of the
    compliance falls as (a/R)³ = 6e-5, so 3e-4 leaves room for its factor.
    """
    block = outline((0, 0, "mount"), (25, 0, None), (25, 25, None), (1, 25, "grip"), (0, 25, None))
    found = torsional_stiffness(block, STEEL, "grip", 1e-4)
    exact = 16 / 3 * STEEL.mu / NMM_PER_NM
    source = "Reissner and Sagoci 1944"
    record("Rigid disc on a half space, K", source, exact, found.K_Nm_per_rad, "N·m/rad")
    assert found.K_Nm_per_rad == pytest.approx(exact, rel=3e-4)


def test_stepped_shaft_between_elementary_bounds(record):
    """Rigid planes at the step only stiffen (series of G J/L); less overhang only softens."""
    step = outline(
        (0, 0, "mount"),
        (10, 0, None),
        (10, 20, None),
        (6, 20, None),
        (6, 50, "grip"),
        (0, 50, None),
    )
    polar = pi / 2 * np.array([10.0, 6.0]) ** 4 * STEEL.mu / NMM_PER_NM
    series = 1 / (20 / polar[0] + 30 / polar[1])
    found = torsional_stiffness(step, STEEL, "grip", 1e-3)
    case, elementary = "Stepped shaft, K", (polar[1] / 50, series)
    record(case, "rigid and free planes at the step", elementary, found.K_Nm_per_rad, "N·m/rad")
    assert found.upper_Nm_per_rad < series
    assert found.lower_Nm_per_rad > polar[1] / 50
    # the step's extra length of the thinner shaft stays below a quarter of its diameter
    # (Peterson's and Griffel's charts of stepped shafts: 0 to 0.11 d for a sharp corner)
    extra = (polar[1] / found.K_Nm_per_rad) - 30 - 20 * polar[1] / polar[0]
    case = "Stepped shaft, extra length over diameter"
    record(case, "Griffel's and Peterson's charts", (0.0, 0.25), extra / 12, digits=2)
    assert 0 < extra < 0.25 * 12


def test_model_page_cup(record):
    """Thin tube and plate in series give 44.7.

    The series counts the whole length as tube; in the solid the plate and the driven ring take
    10 mm of it, so K lies above the series.
    """
    found = torsional_stiffness(MODEL_CUP.meridian(), STEEL, "mesh", 1e-3)
    case, source = "Cup turned evenly, K_b", "tube and plate in series, and above"
    record(case, source, (44.7e3, 60e3), found.K_Nm_per_rad, "N·m/rad")
    assert 44.7e3 < found.lower_Nm_per_rad < found.upper_Nm_per_rad < 60e3


def test_bounds_are_nested_under_refinement():
    """On a straight outline each finer space contains the coarser one, so bounds only tighten."""
    flat = outline(
        (4, 0, "mount"), (9, 0, None), (20, 0, None), (20, 30, "grip"), (20, 35, None),
        (19.5, 35, None), (19.5, 1, None), (4, 1, None),
    )  # fmt: skip
    mesh = triangulate(flat)
    boundary = sorted_boundary(flat, "grip")
    found = []
    for _ in range(4):
        found.append(bracket(mesh, boundary))
        mesh = everywhere(mesh)
    # 1e-6: the polynomial above 1/r³ changes with the triangle, by up to 3/64 (0.5/4)⁴ = 1e-5 at
    # the bore on the first mesh and far less elsewhere
    lower = np.array([b.lower for b in found])
    upper = np.array([b.upper for b in found])
    assert (np.diff(lower) > -1e-6 * lower[0]).all()
    assert (np.diff(upper) < 0).all()
    assert (lower < upper).all()


def test_prager_synge_identity(record):
    """Prager and Synge 1947: the constitutive misfit's energy is upper - lower, so it may steer."""
    mesh = triangulate(annular_plate(3, 20, 4))
    found = bracket(mesh, sorted_boundary(mesh.outline, "grip"))
    gap, misfit = found.upper - found.lower, found.share.sum()
    record("Misfit energy over the bounds' distance", "Prager and Synge 1947", 1.0, misfit / gap)
    assert misfit == pytest.approx(gap, rel=1e-6)


def test_rate_of_convergence(record):
    """P2 on a smooth solution: the energy's error falls as h⁴, 16 fold per halving."""
    mesh = triangulate(annular_plate(5, 20, 6))
    exact = 4 * pi * 6 / (1 / 5**2 - 1 / 20**2)
    boundary = sorted_boundary(mesh.outline, "grip")
    error = []
    for _ in range(4):
        error.append(bracket(mesh, boundary).upper - exact)
        mesh = everywhere(mesh)
    rate = np.log2(error[-2] / error[-1])
    record("Rate of convergence of K", "theory: 4 in the limit", (3.7, np.inf), rate, digits=2)
    assert rate > 3.7


def assert_contains_finer(shape: Meridian, driven: str) -> None:
    coarse = torsional_stiffness(shape, STEEL, driven, 0.02)
    fine = torsional_stiffness(shape, STEEL, driven, 0.002)
    assert coarse.lower_Nm_per_rad <= fine.K_Nm_per_rad <= coarse.upper_Nm_per_rad
    # any two brackets of one K overlap: the sharper statement
    assert max(coarse.lower_Nm_per_rad, fine.lower_Nm_per_rad) <= min(
        coarse.upper_Nm_per_rad, fine.upper_Nm_per_rad
    )
    for level in fine.levels:
        assert level.K_check_Nm_per_rad == pytest.approx(level.K_Nm_per_rad, rel=1e-6)


ANY_PART = st.one_of(
    st.tuples(cups(), st.just("mesh")),
    st.tuples(hats(), st.just("mesh")),
    st.tuples(shafts(), st.just("grip")),
)
SLOW = (HealthCheck.too_slow,)


@settings(max_examples=10, deadline=None, derandomize=True, suppress_health_check=SLOW)
@given(ANY_PART)
def test_bounds_contain_a_ten_times_finer_solution(part):
    assert_contains_finer(*part)


@pytest.mark.long
def test_bounds_contain_a_ten_times_finer_solution_in_200_designs(record):
    held = 0

    @settings(max_examples=200, deadline=None, derandomize=True, suppress_health_check=SLOW)
    @given(ANY_PART)
    def every(part):
        nonlocal held
        assert_contains_finer(*part)
        held += 1

    every()
    record("Random designs whose bounds hold a 10 times finer K", "theorem", 200, held)


def test_grip_across_a_step_and_a_closed_cavity():
    """The step between two gripped pieces has its own constant; a cavity meets the axis."""
    segments = [(4.0, 20.0, 0.0), (24.0, 10.0, 5.0), (6.0, 15.0, 0.0)]
    shaft = Shaft(
        fillet_mm=0.5,
        grip_length_mm=10.0,
        segment=tuple(
            ShaftSegment(length_mm=a, outer_diameter_mm=b, inner_diameter_mm=c)
            for a, b, c in segments
        ),
    )
    found = torsional_stiffness(shaft.meridian(), STEEL, "grip", 1e-3)
    # elementary: free length of 20 mm of the hollow segment; the flange and the grip's far side
    # lengthen it by part of a diameter
    rigid = STEEL.mu * pi / 2 * (5**4 - 2.5**4) / 20 / NMM_PER_NM
    assert rigid * 20 / 30 < found.lower_Nm_per_rad < found.upper_Nm_per_rad < rigid


def test_touching_or_missing_patches_are_refused():
    with pytest.raises(PatchError, match="touch"):
        sorted_boundary(
            outline((1, 0, "mount"), (2, 0, "grip"), (2, 1, None), (1, 1, None)), "grip"
        )
    with pytest.raises(PatchError, match="mesh"):
        sorted_boundary(tube(1, 2, 3), "mesh")
