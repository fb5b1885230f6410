"""Fourier harmonics against a quarter of the same cup in tetrahedra: lobes and ellipse.

Other discretisation, other mesher, other assembly; the hole-free cup is short and thick so that
fifteen thousand tetrahedra resolve it.
"""

from __future__ import annotations

import tomllib
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from example_files import EXAMPLES
from lobe_stiffness import lobe_stiffness

from flexspline.fea.axisymmetric.stress import ellipse_stress
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.load_cases import ellipse, lobes
from flexspline.fea.solid.mesh import mesh_surface
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.peak import SharpEdges, stress_field
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.types import Elastic
from flexspline.geometry.design import Design
from flexspline.geometry.load import design_from
from flexspline.geometry.tagged import tagged_surface

EXAMPLE = EXAMPLES / "xb1-40.toml"
WALL, W0 = 0.9, 0.2

pytestmark = pytest.mark.long


@cache
def design() -> Design:
    data = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    data["flexspline"] |= {
        "bolt_count": 0,
        "length_mm": 18.0,
        "wall_thickness_mm": WALL,
        "ring_thickness_mm": 1.2,
        "diaphragm_thickness_mm": 1.2,
        "ring_width_mm": 6.0,
    }
    return design_from(data)


OF_A_MESH = 0.06
"""Of a stress averaged at nodes of 0.3 to 1.2 mm elements. fTetWild makes another mesh each time: of 11
meshes nine had a peak 1.4 % below to 2.6 % above the meridian's, two one 4.8 % above."""


@cache
def quarter() -> Model:
    surface = tagged_surface(design().part("flexspline"), 90.0, 0.03, edge_spacing=0.1)
    spec = replace(first_spec(design().part("flexspline")), grading=Grading(0.3, 1.2, 1.0))
    return Model.of(mesh_surface(surface, spec), Elastic.of(design().material.flexspline))


@pytest.mark.parametrize("supported", [True, False])
def test_lobe_stiffness(supported, record):
    model = quarter()
    outline = design().part("flexspline").meridian
    exact = lobe_stiffness(outline, model.material, supported, 0.002)
    solved = lobes(model, supported)
    error = energy_error(model.mesh, solved.displacement, model.material).relative
    case = f"Quarter cup under lobes, seat {'supported' if supported else 'free'}, K_b"
    record(case, "our tetrahedra", solved.K_energy, exact.K_Nm_per_rad, "N·m/rad", digits=3)
    assert solved.K_energy > exact.lower_Nm_per_rad  # a load stores too little energy: from above
    # about 0.3 % is estimated on this mesh, and such estimates run 1 to 3 times low
    assert solved.K_energy == pytest.approx(exact.K_Nm_per_rad, rel=3 * error)


def test_ellipse_displacement_and_peak(record):
    model = quarter()
    outline = design().part("flexspline").meridian
    exact = ellipse_stress(outline, model.material, W0, WALL, 0.005)
    u = ellipse(model, W0).displacement
    nodes = model.mesh.nodes
    phi = np.arctan2(nodes[:, 1], nodes[:, 0])
    rim = np.abs(nodes[:, 2] - 18.0) < 1e-6
    cylinder = np.column_stack(
        [
            u[:, 0] * np.cos(phi) + u[:, 1] * np.sin(phi),
            u[:, 1] * np.cos(phi) - u[:, 0] * np.sin(phi),
            u[:, 2],
        ]
    )
    places = exact.places
    amplitudes = exact.displacement[np.abs(places[:, 1] - 18.0) < 1e-9].mean(axis=0)
    wave = np.column_stack([np.cos(2 * phi), np.sin(2 * phi), np.cos(2 * phi)])
    # projected on its wave, the rim's mean motion: amplitudes vary by 1 % across the ring
    found = (cylinder * wave)[rim].sum(axis=0) / (wave[rim] ** 2).sum(axis=0)
    assert found == pytest.approx(amplitudes, rel=0.01)
    turns = np.linspace(0, np.pi / 2, 800)
    edges = np.array(
        [
            (r * np.cos(a), r * np.sin(a), z)
            for r, z in [*outline.sharp_corners, *outline.patch_edges]
            for a in turns
        ]
    )
    peak = stress_field(model.mesh, u, model.material, "", SharpEdges(edges, 90.0, WALL)).peak
    top = exact.peak.mises_MPa
    case = "Cup on the ellipse, peak von Mises stress"
    record(case, "our tetrahedra", peak.mises_MPa, top, "MPa", digits=3)
    assert peak.mises_MPa == pytest.approx(exact.peak.mises_MPa, rel=OF_A_MESH)
    # the same ring around the part, or its rival on the wall's other face: two stresses each so far off may
    # change places when they are twice that apart
    corners = np.array([*outline.sharp_corners, *outline.patch_edges])
    counted = np.linalg.norm(places[:, None] - corners, axis=2).min(axis=1) >= WALL
    rivals = places[
        counted
        & (
            exact.mises(np.arctan2(exact.peak.at_mm[1], exact.peak.at_mm[0]))
            > (1 - 2 * OF_A_MESH) * top
        )
    ]
    rings = np.vstack([exact.peak_rz, rivals])
    found_at = np.array([np.hypot(*peak.at_mm[:2]), peak.at_mm[2]])
    # as far apart as the nodes there
    assert np.abs(rings - found_at).max(axis=1).min() < 0.1
