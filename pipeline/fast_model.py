"""The fast model of a design for the live page: the command line's axisymmetric results, one by one.

K_b of a flexspline with bolt holes is enclosed; everything else leaves holes and keyway out. Every body of
revolution is solved exactly as `flexspline stiffness` does, to the design's own tolerance.
"""

from __future__ import annotations

import numpy as np

from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.types import Stiffness
from flexspline.geometry.design import Design
from flexspline.geometry.part import Part
from flexspline.pipeline.gear.gear_chain import fast_chain
from flexspline.pipeline.gear.gear_curve import GearCurve, curve_of
from flexspline.pipeline.load_cases import CASES
from flexspline.pipeline.peak_with_holes import peak_tolerance
from flexspline.pipeline.revolved import first_rim, stiffness, with_equivalent_ring
from flexspline.pipeline.revolved_stress import ellipse_field, first_ellipse_field, torque_field
from flexspline.pipeline.rim_case import RimCase, held_rim
from flexspline.pipeline.stress_limits import StressCase


def torsion(design: Design) -> tuple[Stiffness, Stiffness]:
    """Return K_b (load case "uniform") and K_e.

    Raises
    ------
    DesignError : the plain ring of drawn teeth does not fit.
    ComputationError : the mesh failed or the tolerance was not met.
    """
    tolerance = design.solver.tolerance
    return stiffness(design, "flexspline", tolerance), stiffness(design, "shaft", tolerance)


def rim(design: Design, case: RimCase) -> Stiffness:
    """Return K_b of a lobe case; errors as `torsion`."""
    return CASES[case].fast(
        with_equivalent_ring(design).part("flexspline"), design.solver.tolerance
    )


def first_lobes(design: Design) -> Stiffness:
    """Return `rim` of "lobes" on each body's first mesh that gives K to 4 %: mostly in half the time."""
    part = with_equivalent_ring(design).part("flexspline")
    return first_rim(part, held_rim, design.solver.tolerance)


def gear(design: Design) -> GearCurve:
    """Solve the whole gear, its shaft without holes; errors as `torsion`; a play may take the stroke."""
    tolerance = design.solver.tolerance
    K_e = stiffness(design, "shaft", tolerance).K_Nm_per_rad
    return curve_of(design, fast_chain(design, K_e, tolerance))


def field(design: Design, view: StressCase) -> RevolvedField:
    """Return displacement and stress of a view of a `revolved` design; errors as `torsion`."""
    part, tolerance = _in_view(design, view), peak_tolerance(design.solver.tolerance)
    if view == "wave_generator":
        return ellipse_field(part, design.w0_mm, tolerance)
    return torque_field(part, design.load.torque_Nm, tolerance)


def first_field(design: Design) -> RevolvedField:
    """Return `field` of the wave generator on the first mesh fine where its peak may be: a third of the time.

    Of 60 random cups and hats its peak was within 2 % for 53, at worst 2.7 % off.
    """
    tolerance = peak_tolerance(design.solver.tolerance)
    return first_ellipse_field(design.part("flexspline"), design.w0_mm, tolerance)


def profile(design: Design, view: StressCase, chord_error: float) -> np.ndarray:
    """Return the meridian (n, 2) [mm] of the part in view, arcs as chords: its shape before any solve."""
    return _in_view(design, view).meridian.polygon(chord_error)


def _in_view(design: Design, view: StressCase) -> Part:
    return design.part("shaft" if view == "shaft_torque" else "flexspline")
