"""The flexspline's rim, condensed to its contacts with teeth and wave generator.

Teeth push at the pitch point, h outside the `mesh` patch, where the tooth goes with the rim's section: with
the rim's rotation ω = (u_θ − ∂u_r/∂φ)/R, the pitch point moves by u_θ + h ω and u_r. Forces
there act on the rim by the transpose, a couple included. (Thin ring without shear: Timoshenko, Strength of
Materials II, art. 14.) The rim opens as a cone, so a tooth is loaded place by place along its face.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi

import numpy as np

from flexspline.fea.axisymmetric.bisection import refined, refined_while
from flexspline.fea.axisymmetric.harmonics import HarmonicModel
from flexspline.fea.axisymmetric.meridian_mesh import MeridianMesh
from flexspline.fea.axisymmetric.triangulate import triangulate
from flexspline.fea.cylindrical import RADIAL, TANGENTIAL
from flexspline.fea.gear.condensed import Condensed, along, condensed, shares_along
from flexspline.fea.types import Elastic
from flexspline.geometry.outline import Meridian


@dataclass(frozen=True)
class Rim:
    """The flexspline at f places along the teeth's face and m places along its seat.

    Attributes
    ----------
    body : ports: pitch point radial (f), pitch point tangential (f), seat radial (m).
    face, seat : (f,), (m,) share of the tooth's face and of the seat that each place stands for.
    """

    body: Condensed
    face: np.ndarray
    seat: np.ndarray

    @property
    def radial(self) -> np.ndarray:
        """Ports of the pitch point (f,)."""
        return np.arange(len(self.face))

    @property
    def tangential(self) -> np.ndarray:
        """Ports of the pitch point (f,)."""
        return len(self.face) + np.arange(len(self.face))

    @property
    def on_seat(self) -> np.ndarray:
        """Ports (m,)."""
        return 2 * len(self.face) + np.arange(len(self.seat))

    def cone(self, stroke: float) -> tuple[np.ndarray, np.ndarray]:
        """How far places of the face stand from its mean while the seat is bent by stroke cos 2φ, evenly.

        Amplitudes (f,) [mm] of u_r, with cos 2φ, and of the pitch point's u_θ, with sin 2φ.
        """
        moved = self.body.harmonics[1][:, self.on_seat] @ self.seat
        moved = moved * stroke / (self.seat @ moved[self.on_seat])
        outwards, along_pitch = moved[self.radial], moved[self.tangential]
        return outwards - self.face @ outwards, along_pitch - self.face @ along_pitch


def places_along(low: float, high: float, count: int) -> np.ndarray:
    """z [mm] of places on a seat, closer towards its edges, on which a rim rests more; one: its middle."""
    if count == 1:
        return np.array([(low + high) / 2])
    return low + (high - low) * (1 - np.cos(np.linspace(0, pi, count))) / 2


def condensed_rim(
    outline: Meridian,
    material: Elastic,
    pitch_radius: float,
    face: np.ndarray,
    seat: np.ndarray,
    last: int,
) -> Rim:
    """`face`, `seat`: z [mm] of the places; `last` harmonic.

    Raises
    ------
    MeshingError, HarmonicError
    """
    mesh = fine_enough(triangulated(outline), "seat", len(seat))
    model = HarmonicModel(fine_enough(mesh, "mesh", len(face)), material)
    ports = [
        *along(model, "mesh", face, RADIAL),
        *along(model, "mesh", face, TANGENTIAL),
        *along(model, "seat", seat),
    ]
    shares = (shares_along(model, patch, z) for patch, z in (("mesh", face), ("seat", seat)))
    rim = Rim(condensed(model, ports, last), *shares)
    body = at_pitch_point(model, pitch_radius, rim.body, rim.radial, rim.tangential)
    return replace(rim, body=body)


def at_pitch_point(
    model: HarmonicModel,
    pitch_radius: float,
    body: Condensed,
    radial: np.ndarray,
    tangential: np.ndarray,
) -> Condensed:
    """Ports of a model's toothed surface, (f,) each, moved to the pitch point over it."""
    surface = float(model.space.places[model.on("mesh"), 0].mean())
    lift = (pitch_radius - surface) / surface
    harmonics = body.harmonics.copy()
    for i, part in enumerate(harmonics):
        lever = np.eye(len(part))
        # u_r = U cos nφ, u_θ = V sin nφ: u_θ − ∂u_r/∂φ = (V + n U) sin nφ
        lever[tangential, tangential] = 1 + lift
        lever[tangential, radial] = lift * 2 * i
        harmonics[i] = lever @ part @ lever.T
    return Condensed(body.tangential, harmonics)


def triangulated(outline: Meridian) -> MeridianMesh:
    """The first mesh, refined once. A further refinement moves K1 to K3 of xb1-40 by 0.1 to 0.3 %."""
    mesh = triangulate(outline)
    return refined(mesh, np.ones(mesh.elements, bool))


def fine_enough(mesh: MeridianMesh, patch: str, places: int) -> MeridianMesh:
    """Refined along the patch until that has two edges for each place."""

    def along(mesh: MeridianMesh) -> np.ndarray:
        ends = mesh.edges[np.isin(mesh.edge_segment, mesh.segments_of(patch))]
        touching = np.isin(mesh.triangles, ends).sum(axis=1) > 1
        return np.asarray(touching & (len(ends) < 2 * places))

    return refined_while(mesh, along)
