"""The flexspline as teeth and wave generator see it, condensed.

Teeth push at the pitch point, h outside the `mesh` patch, where the tooth goes with the rim's section: with
the rim's rotation ω = (u_θ − ∂u_r/∂φ)/R, the pitch point moves by u_θ + h ω and u_r. Forces
there act on the rim by the transpose, a couple included. (Thin ring without shear: Timoshenko, Strength of
Materials II, art. 14.)
"""

from __future__ import annotations

from math import pi

import numpy as np

from flexspline.fea.axisymmetric.bisection import refined
from flexspline.fea.axisymmetric.couplings import RADIAL, TANGENTIAL
from flexspline.fea.axisymmetric.harmonics import HarmonicModel
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.gear.condensed import Condensed, along, condensed, even
from flexspline.fea.types import Elastic
from flexspline.geometry.outline import Meridian

TOOTH_RADIAL, TOOTH_TANGENTIAL, FIRST_PLACE = 0, 1, 2
"""Ports of a rim: the tooth's pitch point, then the places along the seat."""


def places_along(low: float, high: float, count: int) -> np.ndarray:
    """z [mm] of places on a seat, closer towards its edges, on which a rim rests more; one: its middle."""
    if count == 1:
        return np.array([(low + high) / 2])
    return low + (high - low) * (1 - np.cos(np.linspace(0, pi, count))) / 2


def condensed_rim(
    outline: Meridian, material: Elastic, pitch_radius: float, places: np.ndarray, last: int
) -> Condensed:
    """Ports: tooth radial, tooth tangential, seat at each of `places` (z, mm) radial.

    Raises
    ------
    MeshingError, HarmonicError
    """
    model = HarmonicModel(fine_enough(outline, "seat", len(places)), material)
    ports = [even(model, "mesh", RADIAL), even(model, "mesh", TANGENTIAL)]
    found = condensed(model, [*ports, *along(model, "seat", places)], last)
    surface = float(model.space.places[model.on("mesh"), 0].mean())
    return _at_pitch_point(found, (pitch_radius - surface) / surface)


def _at_pitch_point(surface: Condensed, lift: float) -> Condensed:
    """`lift`: height of the pitch point over the radius of the surface."""
    harmonics = surface.harmonics.copy()
    for i, part in enumerate(harmonics):
        lever = np.eye(len(part))
        # u_r = U cos nφ, u_θ = V sin nφ: u_θ − ∂u_r/∂φ = (V + n U) sin nφ
        lever[TOOTH_TANGENTIAL, TOOTH_TANGENTIAL] = 1 + lift
        lever[TOOTH_TANGENTIAL, TOOTH_RADIAL] = lift * 2 * i
        harmonics[i] = lever @ part @ lever.T
    return Condensed(surface.tangential, harmonics)


def fine_enough(outline: Meridian, patch: str, places: int) -> MeridianMesh:
    """The first mesh refined once, then along the patch until that has two edges for each place.

    A further refinement moves K1 to K3 of xb1-40 by 0.1 to 0.3 %.
    """
    mesh = triangulate(outline)
    mesh = refined(mesh, np.ones(mesh.elements, bool))
    while True:
        ends = mesh.edges[np.isin(mesh.edge_segment, mesh.segments_of(patch))]
        if len(ends) >= 2 * places:
            return mesh
        mesh = refined(mesh, np.isin(mesh.triangles, ends).sum(axis=1) > 1)
