"""Peak von Mises stress under the wave generator's ellipse and under torque, on the meridian.

At sharp corners and patch edges the linear solution is singular and no stress converges; points
nearer to them than `exclusion_mm` do not count. A fillet is no sharp edge: points on it count.
"""

from __future__ import annotations

import numpy as np

from flexspline.fea.axisymmetric.bisection import Box
from flexspline.fea.axisymmetric.harmonics import Amplitudes, Fixed, Harmonic, HarmonicModel
from flexspline.fea.axisymmetric.peak_refinement import HarmonicLoad, StressProblem
from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.cylindrical import RADIAL, TANGENTIAL
from flexspline.fea.deadline import NO_DEADLINE, Deadline
from flexspline.fea.types import NMM_PER_NM, Elastic
from flexspline.geometry.outline import Meridian


def ellipse_stress(
    outline: Meridian,
    material: Elastic,
    w0_mm: float,
    exclusion_mm: float,
    tolerance: float,
    deadline: Deadline = NO_DEADLINE,
    boxes: tuple[Box, ...] = (),
) -> RevolvedField:
    """Return the field of the load `ellipse`, refined until its peak is known; see `StressProblem`.

    Raises
    ------
    MeshingError, HarmonicError, StressError, OutOfTimeError : of the first mesh.
    """
    load = ellipse(w0_mm)
    return StressProblem(outline, material, load, exclusion_mm, tolerance, deadline, boxes).field()


def torsion_stress(
    outline: Meridian,
    material: Elastic,
    driven: str,
    torque_Nm: float,
    exclusion_mm: float,
    tolerance: float,
    deadline: Deadline = NO_DEADLINE,
) -> RevolvedField:
    """Return the field of the load `torque`; parameters and errors are those of `ellipse_stress`."""
    load = torque(driven, torque_Nm)
    return StressProblem(outline, material, load, exclusion_mm, tolerance, deadline).field()


def ellipse(w0_mm: float) -> HarmonicLoad:
    """Return the load that holds `mount` and moves `seat` radially by w0 cos 2φ."""
    wave = Harmonic(2)

    def solve(model: HarmonicModel) -> Amplitudes:
        fixed = [Fixed(model.on("seat"), RADIAL, w0_mm), *model.held("mount")]
        return model.solve(wave, fixed, np.zeros(3 * model.space.count))

    return HarmonicLoad(wave, solve)


def torque(driven: str, torque_Nm: float) -> HarmonicLoad:
    """Return the load that holds `mount` and turns `driven` rigidly by a torque."""
    wave = Harmonic(0, torsion=True)

    def solve(model: HarmonicModel) -> Amplitudes:
        on = model.on(driven)
        fixed = [Fixed(on, TANGENTIAL, model.space.places[on, 0]), *model.held("mount")]
        unit = model.solve(wave, fixed, np.zeros(3 * model.space.count))
        angle = torque_Nm * NMM_PER_NM / unit.twice_energy
        return Amplitudes(
            unit.values * angle, unit.twice_energy * angle**2, 0.0, unit.residual, unit.unknowns
        )

    return HarmonicLoad(wave, solve)
