"""The fast model: the bodies of revolution that stand for a design's parts, solved on the meridian.

K_b of a flexspline with bolt holes lies between those of two bodies of revolution (`pipeline.enclosure`).
Everything else leaves holes and keyway out, and drawn teeth are their plain ring. Every answer is
proportional to Young's modulus or to a load: parts are solved for 1 GPa, 1 mm and 1 N·m and remembered, so
another material, torque or clearance costs nothing, and a change of one part leaves the other. `tolerance`
is relative, of K or of the peak stress.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import lru_cache

from flexspline.fea.axisymmetric.contact import contact_stiffness
from flexspline.fea.axisymmetric.lobes import lobe_stiffness
from flexspline.fea.axisymmetric.peak_refinement import StressProblem
from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.axisymmetric.stress import ellipse, ellipse_stress, torsion_stress
from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.types import Elastic, Stiffness, StressPeak
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.keys import without_holes
from flexspline.geometry.material import Material
from flexspline.geometry.part import Part, PartName
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.drawn_teeth import of_toothed
from flexspline.pipeline.enclosure import enclosed
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.storage import cache_folder

KEPT = 512
"""Solved parts remembered: enough for a study's worker, and to go back and forth with a slider."""
KEPT_FIELDS = 32
"""A field is larger than a few figures by a thousand times."""


def revolved(design: Design) -> Design:
    """The bodies of revolution that stand for the design: no holes, teeth as their plain ring.

    Raises
    ------
    DesignError : the plain ring of drawn teeth does not fit.
    """
    return without_holes(with_equivalent_ring(design))


def with_equivalent_ring(design: Design) -> Design:
    """With the plain ring that stands for drawn teeth, as in an analysis; errors as `revolved`."""
    if design.flexspline.teeth == "none":
        return design
    from flexspline.pipeline.analysis import CACHED_TYPES

    cache = Cache(cache_folder(), CACHED_TYPES, lambda line: None)  # what matters comes as an error
    return AnalysisContext(design, cache, Progress()).part("flexspline").context.design


def stiffness(design: Design, name: PartName, tolerance: float) -> Stiffness:
    """K_b of the load case "uniform", or K_e, of a design's part.

    Raises
    ------
    DesignError : the plain ring of drawn teeth does not fit.
    ComputationError : as `torsion`.
    """
    part = with_equivalent_ring(design).part(name)
    found = torsion(part, tolerance)
    return found if part.shape == design.part(name).shape else of_toothed(found)


def torsion(part: Part, tolerance: float) -> Stiffness:
    """K_b of the load case "uniform", or K_e.

    `tolerance` is that of each body of revolution. What misses it has its reason in `shortfall`, here and
    below.

    Raises
    ------
    NestingError
    ComputationError : no mesh, or no solution.
    """
    return _of_holed(part, lambda body: _torsion(body, tolerance))


def lobes(part: Part, supported: bool, tolerance: float) -> Stiffness:
    """K_b under the lobe load; `supported`: the seat may not move radially. Errors as `torsion`."""
    return _of_holed(part, lambda body: _lobes(body, supported, tolerance))


def contact(part: Part, tolerance: float) -> Stiffness:
    """K_b under the lobe load, the seat resting on the wave generator; errors as `torsion`."""
    return _of_holed(part, lambda body: _contact(body, tolerance))


def _of_holed(part: Part, solve: Callable[[Part], Stiffness]) -> Stiffness:
    """Of a flexspline between its two bodies; of a shaft without its holes, then no theorem."""
    unit = _of_1_GPa(part)
    if part.name == "flexspline" and part.bolts is not None:
        found = enclosed(unit, solve)
    else:
        found = solve(unit.without_holes())
        found = replace(found, guaranteed=found.guaranteed and part.is_revolved)
    return found.times(part.material.youngs_modulus_GPa)


def ellipse_peak(part: Part, w0_mm: float, tolerance: float) -> StressPeak:
    """The peak stress on the wave generator's ellipse; errors as `torsion`."""
    found = _ellipse_peak(_body(part), tolerance)
    return found.times(w0_mm * part.material.youngs_modulus_GPa)


def torque_peak(part: Part, torque_Nm: float, tolerance: float) -> StressPeak:
    """The peak stress under a torque; errors as `torsion`."""
    return _torque_peak(_body(part), tolerance).times(torque_Nm)


def ellipse_field(part: Part, w0_mm: float, tolerance: float) -> RevolvedField:
    """Displacement and stress on the wave generator's ellipse; errors as `torsion`."""
    return _on_ellipse(part, w0_mm, _ellipse_field(_body(part), tolerance))


def first_ellipse_field(part: Part, w0_mm: float, tolerance: float) -> RevolvedField:
    """`ellipse_field` before any refinement; to be asked for before it, lest the work is done twice."""
    return _on_ellipse(part, w0_mm, _begun(_body(part), tolerance).newest)


def torque_field(part: Part, torque_Nm: float, tolerance: float) -> RevolvedField:
    """Displacement and stress under a torque; errors as `torsion`."""
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


def _of_1_GPa(part: Part) -> Part:
    """What is solved and remembered: the same shape and Poisson's ratio."""
    nu = part.material.poissons_ratio
    return replace(part, material=Material(name="1 GPa", youngs_modulus_GPa=1.0, poissons_ratio=nu))


def _body(part: Part) -> Part:
    """What stands for a part whose holes are left out."""
    return _of_1_GPa(part.without_holes())


def _elastic(part: Part) -> Elastic:
    return Elastic.of(part.material)


@lru_cache(maxsize=KEPT)
def _torsion(part: Part, tolerance: float) -> Stiffness:
    return torsional_stiffness(part.meridian, _elastic(part), part.driven, tolerance)


@lru_cache(maxsize=KEPT)
def _lobes(part: Part, supported: bool, tolerance: float) -> Stiffness:
    return lobe_stiffness(part.meridian, _elastic(part), supported, tolerance)


@lru_cache(maxsize=KEPT)
def _contact(part: Part, tolerance: float) -> Stiffness:
    return contact_stiffness(part.meridian, _elastic(part), _lobes(part, True, tolerance))


@lru_cache(maxsize=KEPT)
def _ellipse_peak(part: Part, tolerance: float) -> StressPeak:
    """For w0 = 1 mm."""
    return ellipse_stress(part.meridian, _elastic(part), 1.0, part.exclusion_mm, tolerance).peak


@lru_cache(maxsize=KEPT)
def _torque_peak(part: Part, tolerance: float) -> StressPeak:
    """For 1 N·m."""
    return _torque_field(part, tolerance).peak


@lru_cache(maxsize=KEPT_FIELDS)
def _torque_field(part: Part, tolerance: float) -> RevolvedField:
    """For 1 N·m."""
    return torsion_stress(
        part.meridian, _elastic(part), part.driven, 1.0, part.exclusion_mm, tolerance
    )


class _Refining:
    """A field that is solved as far as somebody asked."""

    def __init__(self, meshes: Iterator[RevolvedField]) -> None:
        self._meshes = meshes
        self.newest = next(meshes)

    def last(self) -> RevolvedField:
        """The one within the tolerance."""
        for field in self._meshes:
            self.newest = field
        return self.newest


@lru_cache(maxsize=1)
def _begun(part: Part, tolerance: float) -> _Refining:
    """For w0 = 1 mm; only the newest, for it holds its model."""
    unit = ellipse(w0_mm=1.0)
    return _Refining(
        StressProblem(part.meridian, _elastic(part), unit, part.exclusion_mm, tolerance).fields()
    )


@lru_cache(maxsize=KEPT_FIELDS)
def _ellipse_field(part: Part, tolerance: float) -> RevolvedField:
    """For w0 = 1 mm."""
    try:
        return _begun(part, tolerance).last()
    except ComputationError:
        _begun.cache_clear()  # what ended in an error must not pass for the last mesh
        raise
