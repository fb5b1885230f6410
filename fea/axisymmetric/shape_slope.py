"""dK/dp of a body of revolution under torque, from one solution by the adjoint method.

K is the least energy over all fields with the given rotation, so its derivative with respect to the shape
is that of the energy with the field held (the field is its own adjoint). The mesh follows the outline,
nodal rotations ψ = u_θ/r stay, and the energy's difference over a small step is dK. Source: Haug, Choi,
Komkov, Design Sensitivity Analysis of Structural Systems (1986), ch. 3, for compliance.

Where a dimension gives the outline new corners (a bore that becomes a step) no mesh can follow. There the
same derivative is taken over the free surface: a layer of thickness t there adds its energy, dK = ∫ Gγ² t dA.
"""

from __future__ import annotations

import numpy as np

from flexspline.fea.axisymmetric.followed_mesh import followed
from flexspline.fea.axisymmetric.harmonics import HarmonicModel
from flexspline.fea.axisymmetric.surface_layer import layer_stiffness
from flexspline.fea.axisymmetric.twist import TWIST, Twist
from flexspline.fea.cylindrical import TANGENTIAL
from flexspline.fea.types import NMM_PER_NM
from flexspline.geometry.outline import Meridian


def moved_stiffness(solved: Twist, outline: Meridian) -> float:
    """Return twice the energy per rad² [N·m/rad] of the held field on another outline, a small step away.

    Raises
    ------
    HeldSurfaceError : the outline has new corners, and a surface that is held or turned moves.
    """
    if len(outline.segments) != len(solved.mesh.outline.segments):
        return solved.K_Nm_per_rad + layer_stiffness(solved, outline)
    model = HarmonicModel(followed(solved.mesh, outline), solved.material)
    values = np.zeros((model.space.count, 3))
    values[:, TANGENTIAL] = solved.rotation * model.space.places[:, 0]
    u = values.ravel()
    return float(u @ (model.stiffness(TWIST) @ u)) / NMM_PER_NM
