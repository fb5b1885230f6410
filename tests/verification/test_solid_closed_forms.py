"""Solid elements against closed forms: Timoshenko and Goodier, Theory of Elasticity, 3rd ed., 1970.

Torsion of tubes §109 (K = GJ/L), circular disc in its plane §43 (shear of an annulus), thick
cylinder §28 (Lamé), thin ring: Timoshenko, Strength of Materials II §17. The meshes are structured
and hand-made.
"""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from structured import sector_mesh

from flexspline.fea.cylindrical import AXIAL, RADIAL, TANGENTIAL
from flexspline.fea.solid.assembly import NodeFrames
from flexspline.fea.solid.load_cases import ellipse, torsion
from flexspline.fea.solid.model import Model, Supports
from flexspline.fea.solid.stress import nodal_stress, von_mises
from flexspline.fea.types import Elastic

STEEL = Elastic(206e3, 0.3)
BOOK = "Timoshenko and Goodier"
NMM_PER_NM = 1000.0


def at(component: int, value: float):
    return lambda c: np.isclose(c[:, component], value)


def tube(ri: float, ro: float, length: float, n: int, arcs: int = 6, shake: float = 0.0):
    return sector_mesh(
        np.linspace(ri, ro, n + 1),
        np.linspace(0, pi / 6, arcs + 1),
        np.linspace(0, length, 2 * n + 1),
        {"mount": at(2, 0.0), "mesh": at(2, length)},
        shake,
    )


def test_tube_in_torsion(record) -> None:
    """K = G·π(ro⁴ − ri⁴)/(2L); the field is quadratic: only the curved boundary is approximated."""
    ri, ro, length = 18.0, 20.0, 25.0
    exact = STEEL.mu * pi * (ro**4 - ri**4) / 2 / length / NMM_PER_NM
    errors = []
    for n in (1, 2, 4):
        K = torsion(Model.of(tube(ri, ro, length, n, arcs=3 * n), STEEL), "mesh").K_energy
        errors.append(K / exact - 1)
    record("Tube in torsion, K", f"{BOOK} §109", exact, exact * (1 + errors[2]), "N·m/rad")
    # parabolic arcs approximate a circle with an error of fourth order in their angle
    assert errors[0] / errors[1] > 2**3
    assert errors[1] / errors[2] > 2**3
    assert abs(errors[2]) < 1e-5  # (5°/2 in radians)⁴ = 4e-6


def test_thin_tube_formula(record) -> None:
    """2πGR³t/L (Bredt) is the limit t → 0 of the same K: off by t²/(4R²)."""
    ri, ro, length = 19.2, 19.6, 25.0
    K = torsion(Model.of(tube(ri, ro, length, 1, arcs=20), STEEL), "mesh").K_energy
    middle, wall = (ri + ro) / 2, ro - ri
    thin = 2 * pi * STEEL.mu * middle**3 * wall / length / NMM_PER_NM
    record("Thin tube, K", "2πGR³t/L (Bredt)", thin, K, "N·m/rad")
    assert thin * (1 + wall**2 / (4 * middle**2)) == pytest.approx(K, rel=2e-5)


def plate(n: int):
    ri, ro, h = 9.0, 18.0, 0.6
    mesh = sector_mesh(
        np.linspace(ri, ro, 4 * n + 1),
        np.linspace(0, pi / 6, 3 * n + 1),
        np.linspace(0, h, 2),
        {"mount": at(0, ri), "mesh": at(0, ro)},
    )
    return mesh, 4 * pi * STEEL.mu * h / (1 / ri**2 - 1 / ro**2) / NMM_PER_NM


def test_annular_plate_in_shear(record) -> None:
    """K = 4πGh/(1/ri² − 1/ro²), from above."""
    mesh, exact = plate(3)
    K = torsion(Model.of(mesh, STEEL), "mesh").K_energy
    record("Annular plate in shear, K", f"{BOOK} §43", exact, K, "N·m/rad")
    assert 0 < K / exact - 1 < 1e-5


def test_stiffness_error_falls_at_the_rate_of_quadratic_elements(record) -> None:
    """Energy error ~ h⁴ for quadratic elements on a smooth field; demanded ≥ 3."""
    errors = []
    for n in (1, 2, 4):
        mesh, exact = plate(n)
        errors.append(torsion(Model.of(mesh, STEEL), "mesh").K_energy / exact - 1)
    rates = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    record("Rate of convergence of K", "theory: 4 in the limit", (3.0, np.inf), rates[-1], digits=2)
    assert (rates > 3).all(), rates


def test_lame_cylinder(record) -> None:
    """Thick cylinder, inner surface moved out by u, plane strain: u_r = A r + B/r."""
    ri, ro, u = 10.0, 20.0, 0.01
    mesh = sector_mesh(
        np.linspace(ri, ro, 13), np.linspace(0, pi / 6, 13), np.linspace(0, 2, 3),
        {"inner": at(0, ri), "low": at(2, 0.0), "high": at(2, 2.0)},
    )  # fmt: skip
    model = Model.of(mesh, STEEL)
    supports = Supports(model)
    supports.symmetry(antisymmetric=False)
    for end in ("low", "high"):
        supports.set(mesh.nodes_on(end), AXIAL)
    supports.set(mesh.nodes_on("inner"), RADIAL, u)
    solved = supports.solve(np.zeros(model.matrix.shape[0]))
    # traction-free outside: 2(λ + μ)A = 2μB/ro²
    ratio = (STEEL.lam + STEEL.mu) * ro**2 / STEEL.mu
    A = u / (ri + ratio / ri)
    B = ratio * A
    radius = model.frames.radius
    found = solved.unknowns.reshape(-1, 3)[:, RADIAL]
    # interpolation of B/r by quadratics: h³u‴/64 = 6(h/r)³/64 = 5e-5 of u at the bore
    assert found == pytest.approx(A * radius + B / radius, rel=1e-4)
    stress = nodal_stress(mesh, model.frames.to_cartesian(solved.unknowns.reshape(-1, 3)), STEEL)
    hoop = np.einsum(
        "na,nab,nb->n", *(model.frames.axes[:, :, 1], stress, model.frames.axes[:, :, 1])
    )
    exact = 2 * STEEL.lam * A + 2 * STEEL.mu * (A + B / radius**2)
    outside, bore = np.isclose(radius, ro), np.isclose(radius, ri)
    moved, wanted = found[outside].mean(), A * ro + B / ro
    record("Lamé cylinder, outer displacement", f"{BOOK} §28", wanted * 1e3, moved * 1e3, "µm")
    most = hoop[bore].max()
    record("Lamé cylinder, hoop stress at the bore", f"{BOOK} §28", exact.max(), most, "MPa")
    # stress is one order less accurate than displacement, and one-sided at the bore
    assert np.abs(hoop - exact).max() < 0.01 * exact.max()


def test_thin_ring_on_the_ellipse(record) -> None:
    """σ = E/(1 − ν²)·(t/2)·3w0/R² at the surface, wide ring: plane strain."""
    R, t, w0 = 20.0, 0.4, 0.2
    width = 1.0
    mesh = sector_mesh(
        np.linspace(R - t / 2, R + t / 2, 3), np.linspace(0, pi / 2, 61), np.linspace(0, width, 2),
        {"seat": at(0, R - t / 2), "low": at(2, 0.0), "high": at(2, width)},
    )  # fmt: skip
    model = Model.of(mesh, STEEL)
    supports = Supports(model)
    supports.symmetry(antisymmetric=False)
    seat = mesh.nodes_on("seat")
    phi = np.arctan2(mesh.nodes[:, 1], mesh.nodes[:, 0])
    supports.set(seat, RADIAL, w0 * np.cos(2 * phi[seat]))
    for end in ("low", "high"):
        supports.set(mesh.nodes_on(end), AXIAL)
    solved = supports.solve(np.zeros(model.matrix.shape[0]))
    stress = nodal_stress(mesh, model.frames.to_cartesian(solved.unknowns.reshape(-1, 3)), STEEL)
    frames = model.frames.axes[:, :, 1]
    hoop = np.einsum("na,nab,nb->n", frames, stress, frames)
    outside = np.isclose(model.frames.radius, R + t / 2)
    expected = STEEL.youngs_modulus_MPa / (1 - 0.3**2) * t / 2 * 3 * w0 / R**2
    # the formula's own error is of order t/R = 2 % (radius of the fibre, shear of the section)
    most = np.abs(hoop[outside]).max()
    record("Ring bent to an ellipse, stress", "Timoshenko II §17, thin ring", expected, most, "MPa")
    assert most == pytest.approx(expected, rel=0.03)


def test_ellipse_case_is_symmetric_about_both_axes() -> None:
    mesh = sector_mesh(
        np.linspace(19, 20, 2), np.linspace(0, pi / 2, 19), np.linspace(0, 5, 4),
        {"mount": at(2, 0.0), "seat": lambda c: np.isclose(c[:, 0], 19) & (c[:, 2] > 3)},
    )  # fmt: skip
    solved = ellipse(Model.of(mesh, STEEL), 0.1)
    frames = NodeFrames.cylindrical(mesh.nodes)
    u = np.einsum("nab,na->nb", frames.axes, solved.displacement)
    phi = np.arctan2(mesh.nodes[:, 1], mesh.nodes[:, 0])
    for edge in (0.0, pi / 2):
        assert np.abs(u[np.isclose(phi, edge), TANGENTIAL]).max() == 0.0
    rim = np.isclose(mesh.nodes[:, 2], 5) & np.isclose(frames.radius, 19)
    assert u[rim, RADIAL] == pytest.approx(0.1 * np.cos(2 * phi[rim]), abs=1e-12)


def test_patch_test_on_a_distorted_mesh(record) -> None:
    """Irons' patch test: linear displacements on the boundary are reproduced inside, to rounding."""
    mesh = tube(10.0, 14.0, 4.0, 2, shake=0.3)
    straight = mesh.nodes.copy()
    for i, (a, b) in enumerate(((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))):
        straight[mesh.cells[:, 4 + i]] = straight[mesh.cells[:, [a, b]]].mean(axis=1)
    from dataclasses import replace

    mesh = replace(mesh, nodes=straight)
    model = Model.of(mesh, STEEL)
    gradient = np.array([[1.0, 2.0, -1.0], [0.5, -1.0, 3.0], [2.0, 0.3, 0.7]]) * 1e-3
    exact = mesh.nodes @ gradient.T
    local = np.einsum("nab,na->nb", model.frames.axes, exact)
    supports = Supports(model)
    boundary = np.unique(mesh.facets)
    for component in (RADIAL, TANGENTIAL, AXIAL):
        supports.set(boundary, component, local[boundary, component])
    solved = supports.solve(np.zeros(model.matrix.shape[0])).unknowns.reshape(-1, 3)
    off = np.abs(solved - local).max() / np.abs(exact).max()
    record("Patch test on a distorted mesh, displacement", "Irons: exact", 0.0, off)
    assert len(boundary) < len(mesh.nodes)
    assert off < 1e-9  # rounding, through a direct solve
    strain = (gradient + gradient.T) / 2
    stress = 2 * STEEL.mu * strain + STEEL.lam * np.trace(strain) * np.eye(3)
    found = nodal_stress(mesh, exact, STEEL)
    assert von_mises(found) == pytest.approx(von_mises(stress), rel=1e-9)


def test_rigid_motions_carry_no_energy(record) -> None:
    mesh = tube(10.0, 14.0, 4.0, 2, shake=0.3)
    model = Model.of(mesh, STEEL)
    x, y, z = mesh.nodes.T
    one, zero = np.ones_like(x), np.zeros_like(x)
    modes = [
        (one, zero, zero), (zero, one, zero), (zero, zero, one),
        (-y, x, zero), (zero, -z, y), (z, zero, -x),
    ]  # fmt: skip
    scale = np.abs(model.matrix).max()
    most = 0.0
    for mode in modes:
        u = np.einsum("nab,na->nb", model.frames.axes, np.stack(mode, axis=1)).ravel()
        energy = u @ (model.matrix @ u)
        most = max(most, abs(energy) / (scale * (u @ u)))
    record("Energy of the six rigid motions", "exact", 0.0, most)
    assert most < 1e-12  # rounding
