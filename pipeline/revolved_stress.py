"""Stress and displacement by the fast model (`pipeline.revolved`): holes and keyway left out.

Solved for 1 GPa, 1 mm and 1 N·m and remembered; `tolerance` is relative, of the peak stress.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from flexspline.fea.axisymmetric.peak_refinement import HarmonicLoad, StressProblem
from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.axisymmetric.stress import ellipse, torque
from flexspline.fea.types import Elastic, StressPeak
from flexspline.geometry.meridian import with_narrow_seat
from flexspline.geometry.part import Part
from flexspline.pipeline.ellipse_peak import NARROW_SEAT
from flexspline.pipeline.refining import Refining
from flexspline.pipeline.revolved import KEPT_PARTS, of_1_GPa

KEPT_FIELDS = 32
"""A field is larger than a few figures by a thousand times."""


def ellipse_peak(part: Part, w0_mm: float, tolerance: float) -> StressPeak:
    """Return the peak stress on the wave generator's ellipse; errors as `torsion`."""
    return _ellipse_peak(_body(part), tolerance).times(w0_mm * part.material.youngs_modulus_GPa)


def half_seat_peak(part: Part, w0_mm: float, tolerance: float) -> StressPeak:
    """Return the ellipse's peak on a seat half as wide as the ring; errors as `torsion`."""
    return _half_seat_peak(_body(part), tolerance).times(w0_mm * part.material.youngs_modulus_GPa)


def torque_peak(part: Part, torque_Nm: float, tolerance: float) -> StressPeak:
    """Return the peak stress under a torque; errors as `torsion`."""
    return _torque_peak(_body(part), tolerance).times(torque_Nm)


def ellipse_field(part: Part, w0_mm: float, tolerance: float) -> RevolvedField:
    """Return displacement and stress on the wave generator's ellipse; errors as `torsion`."""
    return _on_ellipse(part, w0_mm, _ellipse_field(_body(part), tolerance))


def first_ellipse_field(part: Part, w0_mm: float, tolerance: float) -> RevolvedField:
    """Return `ellipse_field` before any refinement; ask for it first, or the work is done twice."""
    return _on_ellipse(part, w0_mm, _begun(_body(part), tolerance).newest)


def torque_field(part: Part, torque_Nm: float, tolerance: float) -> RevolvedField:
    """Return displacement and stress under a torque; errors as `torsion`."""
    unit = _torque_field(_body(part), tolerance)
    return _loaded(unit, torque_Nm, torque_Nm / part.material.youngs_modulus_GPa)


def _on_ellipse(part: Part, w0_mm: float, unit: RevolvedField) -> RevolvedField:
    return _loaded(unit, part.material.youngs_modulus_GPa * w0_mm, w0_mm)


def _loaded(unit: RevolvedField, stress: float, displacement: float) -> RevolvedField:
    """The unit solution times its load."""
    return replace(
        unit,
        displacement=unit.displacement * displacement,
        stress=unit.stress * stress,
        peak=unit.peak.times(stress),
    )


def _body(part: Part) -> Part:
    """What stands for a part whose holes are left out."""
    return of_1_GPa(part.without_holes())


def _problem(part: Part, load: HarmonicLoad, tolerance: float) -> StressProblem:
    return StressProblem(
        part.meridian, Elastic.of(part.material), load, part.exclusion_mm, tolerance
    )


@lru_cache(maxsize=KEPT_PARTS)
def _ellipse_peak(part: Part, tolerance: float) -> StressPeak:
    """For w0 = 1 mm."""
    return _problem(part, ellipse(w0_mm=1.0), tolerance).field().peak


@lru_cache(maxsize=KEPT_PARTS)
def _half_seat_peak(part: Part, tolerance: float) -> StressPeak:
    """For w0 = 1 mm."""
    problem = _problem(part, ellipse(w0_mm=1.0), tolerance)
    return replace(problem, outline=with_narrow_seat(part.meridian, NARROW_SEAT)).field().peak


@lru_cache(maxsize=KEPT_PARTS)
def _torque_peak(part: Part, tolerance: float) -> StressPeak:
    """For 1 N·m."""
    return _torque_field(part, tolerance).peak


@lru_cache(maxsize=KEPT_FIELDS)
def _torque_field(part: Part, tolerance: float) -> RevolvedField:
    """For 1 N·m."""
    return _problem(part, torque(part.driven, torque_Nm=1.0), tolerance).field()


@lru_cache(maxsize=1)
def _begun(part: Part, tolerance: float) -> Refining[RevolvedField]:
    """For w0 = 1 mm; only the newest, for it holds its model."""
    return Refining(_problem(part, ellipse(w0_mm=1.0), tolerance).fields())


@lru_cache(maxsize=KEPT_FIELDS)
def _ellipse_field(part: Part, tolerance: float) -> RevolvedField:
    """For w0 = 1 mm."""
    return _begun(part, tolerance).last()
