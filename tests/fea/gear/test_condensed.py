"""Condensed bodies against direct solutions, closed forms of rings, and the lobe cases."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.fea.axisymmetric.contact import lift_off_forces
from flexspline.fea.axisymmetric.harmonics import Fixed, Harmonic, HarmonicModel
from flexspline.fea.axisymmetric.lift_off import pushing
from flexspline.fea.axisymmetric.lobes import LOBE_HALF_WIDTH
from flexspline.fea.axisymmetric.seat import seat_compliance
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.cylindrical import AXIAL, RADIAL, TANGENTIAL
from flexspline.fea.gear.condensed import along, condensed, even
from flexspline.fea.gear.outer_race import condensed_race, race_outline
from flexspline.fea.gear.rim import condensed_rim, fine_enough, places_along, triangulated
from flexspline.fea.types import NMM_PER_NM, Elastic
from flexspline.geometry.load import load_design

STEEL = Elastic(206e3, 0.3)
DESIGN = load_design(EXAMPLES / "xb1-40.toml")
CUP = DESIGN.part("flexspline").without_holes().meridian
SURFACE = DESIGN.flexspline.ring_radius


def seat_places(count: int) -> np.ndarray:
    return places_along(DESIGN.flexspline.ring_start, DESIGN.flexspline.ring_end, count)


def face_places(count: int) -> np.ndarray:
    return np.linspace(DESIGN.flexspline.ring_start, DESIGN.flexspline.ring_end, count)


@pytest.mark.parametrize("n", [0, 2, 10])
def test_an_entry_is_the_direct_solution_both_ways(n: int) -> None:
    """Reciprocity: tooth round → seat outwards, and the seat's push → the teeth's way round."""
    model = HarmonicModel(triangulate(CUP), STEEL)
    ports = [even(model, "mesh", TANGENTIAL), *along(model, "seat", seat_places(3))]
    found = condensed(model, ports, 12).harmonics[n // 2]
    wave = Harmonic(n, torsion=False)
    if n == 0:
        assert found[0, 1:] == pytest.approx(0)  # torsion moves nothing outwards
        return
    moved = []
    for pushed, read in ((0, 2), (2, 0)):
        load = np.zeros((model.space.count, 3))
        load[:, ports[pushed].component] = wave.around * ports[pushed].weights
        u = model.solve(wave, model.held("mount"), load.ravel()).values.reshape(-1, 3)
        moved.append(float(u[:, ports[read].component] @ ports[read].weights))
    assert moved[0] == pytest.approx(moved[1], rel=1e-9)
    assert found[0, 2] == pytest.approx(moved[0], rel=1e-9)


def test_a_thin_ring_bends_as_rings_do() -> None:
    """w = q R⁴/(E I (n² − 1)²) under q cos nφ per length; plane stress, as the ring is narrow."""
    inner, thick, width = 20.0, 0.2, 0.2
    outline = race_outline(inner + thick, thick, 0.0, width, width / 3)
    model = HarmonicModel(fine_enough(triangulated(outline), "seat", 1), STEEL)
    still = Fixed(model.on("groove")[:1], AXIAL)
    found = condensed(model, [even(model, "seat", RADIAL)], 6, loose=[still]).harmonics[:, 0, 0]
    middle, inertia = inner + thick / 2, width * thick**3 / 12
    for n in (2, 4, 6):
        per_radian = middle**3 / (STEEL.youngs_modulus_MPa * inertia * (n * n - 1) ** 2)
        # a hundredth of R thick: shear and stretching add (n t/R)² or so
        assert found[n // 2] == pytest.approx(per_radian, rel=0.01)
    breathing = middle / (STEEL.youngs_modulus_MPa * width * thick)  # q R²/(E A), q = 1/R
    assert found[0] == pytest.approx(breathing, rel=0.01)


def test_a_point_force_is_its_harmonics() -> None:
    """Equal forces at equal angles are even: their responses add up to the harmonic 0."""
    race = condensed_race(race_outline(19.2, 0.8, 0.0, 8.0, 1.0), STEEL, np.array([4.0]), 16)
    angles = np.arange(16) * pi / 16
    matrix = race.compliance(np.zeros(16, int), angles)
    assert matrix == pytest.approx(matrix.T)
    even_push = matrix.sum(axis=1)  # 1 N at each of 16 angles a half turn: 16/π N/rad all round
    assert even_push == pytest.approx(16 / pi * race.harmonics[0, 0, 0])
    assert np.linalg.eigvalsh(matrix).min() > 0


def test_turning_the_gear_as_one_is_torsion() -> None:
    """Even torque: a ring turned rigidly has 31 330 to 31 337 N·m/rad (docs/validation.md).

    Even traction leaves the ring to twist: that adds the mean over its width b, b/3 of its G J, at most.
    """
    f = DESIGN.flexspline
    polar = pi / 2 * (f.ring_radius**4 - f.inner_radius**4)
    ring = 3 * STEEL.mu * polar / f.ring_width_mm / NMM_PER_NM
    least = 1 / (1 / 31_330 + 1 / ring)
    for pitch in (SURFACE, 20.0):
        rim = condensed_rim(CUP, STEEL, pitch, face_places(1), seat_places(3), 4)
        torque = 2 * pi * pitch  # of 1 N/rad
        K = torque / (rim.body.harmonics[0, 1, 1] / pitch) / NMM_PER_NM
        assert least < K < 31_337


def test_prescribed_teeth_on_a_rigid_bearing_give_the_resting_lobes() -> None:
    """cos² forces about the major axis, a circle's seat that may lift off: K_b_lobes_contact's own case."""
    angles, m = 32, 5
    mesh = fine_enough(triangulated(CUP), "seat", m)
    seat = seat_compliance(HarmonicModel(mesh, STEEL), angles, 33)
    expected = seat.stiffness(lift_off_forces(seat))

    rim = condensed_rim(CUP, STEEL, SURFACE, face_places(1), seat_places(m), angles)
    rims = np.arange(angles) * pi / angles
    phi = (np.arange(64) + 0.5) / 64 * 2 * LOBE_HALF_WIDTH - LOBE_HALF_WIDTH
    bump = np.cos(pi * phi / (2 * LOBE_HALF_WIDTH)) ** 2
    teeth = bump / bump.sum() * NMM_PER_NM / 2 / SURFACE  # N, half the torque at each lobe
    port = np.concatenate([np.full(64, 1), np.tile(2 + np.arange(m), angles)])
    matrix = rim.body.compliance(port, np.concatenate([phi, np.repeat(rims, m)]))
    free = matrix[64:, :64] @ teeth
    push = pushing(matrix[64:, 64:], free)
    half_work = teeth @ (matrix[:64, :64] @ teeth + matrix[:64, 64:] @ push)
    K = NMM_PER_NM / (2 * half_work)
    # 5 places along the seat for 33: within 1 %
    assert pytest.approx(expected, rel=0.01) == K
