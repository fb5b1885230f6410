"""Forces on the walls of cuts that take a harmonic's tractions off them, as a wave on half a repeat."""

from __future__ import annotations

from functools import partial

import numpy as np

from flexspline.fea.axisymmetric.field_at_points import FieldAtPoints
from flexspline.fea.axisymmetric.recovery import R_THETA, THETA_Z
from flexspline.fea.solid.superposition import Walls, around
from flexspline.fea.solid.waves import CyclicWave, waves


def harmonic_walls(
    walls: Walls, without_cuts: FieldAtPoints, repeats: int
) -> tuple[CyclicWave, np.ndarray]:
    """Return the wave and its forces (n, 3) Cartesian [N], complex where the wave is.

    The tractions are those of the smoothed stress, which is added to the stress of what the forces change.

    Raises
    ------
    MeshingError : a wall leaves the meridian.
    """
    n = without_cuts.field.n
    (wave,) = waves((n,), repeats)
    shapes = (np.cos, np.sin if n else np.ones_like)  # torsion is constant
    cosine, sine = (wave.of(partial(around, f, n), walls.phi) for f in shapes)
    _, amplitudes = without_cuts.amplitudes(walls.r.ravel(), walls.z.ravel())
    even = dict(enumerate(amplitudes.T))
    odd = {k: even.pop(k) for k in (R_THETA, THETA_Z)}
    return wave, walls.forces(-(cosine * walls.pull(even) + sine * walls.pull(odd)))
