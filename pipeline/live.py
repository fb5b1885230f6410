"""A design while its dimensions move: the command line's axisymmetric answers, piece by piece.

Bolt holes and keyway are left out (`left_out` says so); what is left is solved exactly as `flexspline
stiffness` solves a body of revolution, to the design's own tolerance. Every piece is proportional to
Young's modulus or to a load, so parts are solved for 1 GPa, 1 mm and 1 N·m and remembered: a change of
the material, the torque or a clearance costs nothing, and a change of one part leaves the other.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np

from flexspline.fea.axisymmetric.contact import contact_stiffness
from flexspline.fea.axisymmetric.lobes import lobe_stiffness
from flexspline.fea.axisymmetric.stress import RevolvedField, ellipse_refinements, torsion_stress
from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.types import Elastic, Stiffness
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.keys import without_holes
from flexspline.geometry.shapes import Cup, Hat
from flexspline.pipeline.load_cases import STRESS_TOLERANCE
from flexspline.pipeline.study.evaluate import Shape, of_1_GPa, with_equivalent_ring

View = Literal["flexspline_torque", "wave_generator", "shaft_torque"]
RimCase = Literal["K_b_lobes", "K_b_lobes_contact", "K_b_lobes_unsupported"]
KEPT = 256
"""Solved parts remembered: enough to go back and forth with one slider."""


@dataclass(frozen=True)
class Bounded:
    """A stiffness between its bounds [N·m/rad]; `guaranteed`: both are theorems about the design's part."""

    K_Nm_per_rad: float
    lower_Nm_per_rad: float
    upper_Nm_per_rad: float
    guaranteed: bool

    @property
    def bounds_Nm_per_rad(self) -> tuple[float, float]:
        """Lower and upper."""
        return self.lower_Nm_per_rad, self.upper_Nm_per_rad


def left_out(design: Design) -> tuple[str, ...]:
    """What the fast model does not see, in words; empty for bodies of revolution."""
    found = []
    for part in design.parts:
        if part.bolts:
            found.append(f"{part.bolts.count} bolt holes of the {part.name}")
    if design.part("shaft").keyway is not None:
        found.append("the keyway")
    return tuple(found)


def revolved(design: Design) -> Design:
    """The bodies of revolution that stand for the design: no holes, teeth as their plain ring."""
    return without_holes(with_equivalent_ring(design))


def torsion(design: Design) -> tuple[Bounded, Bounded]:
    """K_b (load case "uniform") and K_e of the bodies that stand for a design's parts.

    Their bounds are theorems about the parts themselves only where nothing was left out or replaced.

    Raises
    ------
    DesignError : the plain ring of drawn teeth does not fit.
    ComputationError : the mesh failed or the tolerance was not met.
    """
    plain, tolerance = revolved(design), design.solver.tolerance_pct / 100
    own, shaft = plain.material.flexspline, plain.part("shaft").material
    K_b = _torsion(plain.flexspline, own.poissons_ratio, tolerance)
    K_e = _torsion(plain.shaft, shaft.poissons_ratio, tolerance)
    found = _scaled(K_b, own.youngs_modulus_GPa), _scaled(K_e, shaft.youngs_modulus_GPa)
    exact = plain.flexspline == design.flexspline, plain.shaft == design.shaft
    b, e = (
        replace(k, guaranteed=k.guaranteed and same) for k, same in zip(found, exact, strict=True)
    )
    return b, e


def rim(design: Design, case: RimCase) -> Bounded:
    """K_b of a lobe case of a `revolved` design; errors as `torsion`."""
    own, tolerance = design.material.flexspline, design.solver.tolerance_pct / 100
    solve = _contact if case == "K_b_lobes_contact" else _lobes
    supported = case != "K_b_lobes_unsupported"
    found = solve(design.flexspline, own.poissons_ratio, tolerance, supported)
    return _scaled(found, own.youngs_modulus_GPa)


def field(design: Design, view: View) -> RevolvedField:
    """Displacement and stress of a view of a `revolved` design; errors as `torsion`."""
    if view == "wave_generator":
        nu = design.material.flexspline.poissons_ratio
        return _on_wave_generator(design, _ellipse(design.flexspline, nu))
    part = design.part("shaft" if view == "shaft_torque" else "flexspline")
    own = part.material
    unit = _twisted(part.shape, own.poissons_ratio)
    torque = design.load.torque_Nm
    return _loaded(unit, torque, torque / own.youngs_modulus_GPa)


def first_field(design: Design) -> RevolvedField:
    """`field` of the wave generator before any refinement, in a third of the time.

    Of 40 cups and hats drawn about the examples its peak was within 1 % for 37, at worst 11 % off.
    """
    nu = design.material.flexspline.poissons_ratio
    return _on_wave_generator(design, _begun(design.flexspline, nu).newest)


def _on_wave_generator(design: Design, unit: RevolvedField) -> RevolvedField:
    w0 = design.gear.centre_distance_mm
    return _loaded(unit, design.material.flexspline.youngs_modulus_GPa * w0, w0)


def _loaded(unit: RevolvedField, stress: float, displacement: float) -> RevolvedField:
    """The unit solution times its load."""
    return replace(
        unit,
        displacement=unit.displacement * displacement,
        stress=unit.stress * stress,
        peak=unit.peak.times(stress),
    )


def profile(design: Design, view: View, chord_error: float) -> np.ndarray:
    """The meridian (n, 2) [mm] of the part in view, arcs as chords: its shape before any solve."""
    part = design.part("shaft" if view == "shaft_torque" else "flexspline")
    return part.meridian.polygon(chord_error)


def _scaled(of_1_GPa: Stiffness, E_GPa: float) -> Bounded:
    return Bounded(
        of_1_GPa.K_Nm_per_rad * E_GPa,
        of_1_GPa.lower_Nm_per_rad * E_GPa,
        of_1_GPa.upper_Nm_per_rad * E_GPa,
        of_1_GPa.guaranteed,
    )


@lru_cache(maxsize=KEPT)
def _torsion(shape: Shape, nu: float, tolerance: float) -> Stiffness:
    part = of_1_GPa(shape, nu)
    return torsional_stiffness(part.meridian, Elastic.of(part.material), part.driven, tolerance)


@lru_cache(maxsize=KEPT)
def _lobes(shape: Shape, nu: float, tolerance: float, supported: bool) -> Stiffness:
    part = of_1_GPa(shape, nu)
    return lobe_stiffness(part.meridian, Elastic.of(part.material), supported, tolerance)


@lru_cache(maxsize=KEPT)
def _contact(shape: Shape, nu: float, tolerance: float, supported: bool) -> Stiffness:
    part = of_1_GPa(shape, nu)
    return contact_stiffness(
        part.meridian, Elastic.of(part.material), _lobes(shape, nu, tolerance, supported)
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
def _begun(shape: Cup | Hat, nu: float) -> _Refining:
    """For w0 = 1 mm; only the newest, for it holds its model."""
    part = of_1_GPa(shape, nu)
    apart = part.exclusion_mm
    meshes = ellipse_refinements(
        part.meridian, Elastic.of(part.material), 1.0, apart, STRESS_TOLERANCE
    )
    return _Refining(meshes)


@lru_cache(maxsize=KEPT // 8)
def _ellipse(shape: Cup | Hat, nu: float) -> RevolvedField:
    """For w0 = 1 mm; the field is kept, so fewer of them."""
    try:
        return _begun(shape, nu).last()
    except ComputationError:
        _begun.cache_clear()  # what ended in an error must not pass for the last mesh
        raise


@lru_cache(maxsize=KEPT // 8)
def _twisted(shape: Shape, nu: float) -> RevolvedField:
    """For 1 N·m; the field is kept, so fewer of them."""
    part = of_1_GPa(shape, nu)
    apart = part.exclusion_mm
    return torsion_stress(
        part.meridian, Elastic.of(part.material), part.driven, 1.0, apart, STRESS_TOLERANCE
    )
