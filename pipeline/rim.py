"""What the lobes and the wave generator do to the flexspline's rim: axisymmetric or solid."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from fea.axisymmetric.contact import contact_stiffness
from fea.axisymmetric.lobes import lobe_stiffness as revolved_lobe_stiffness
from fea.axisymmetric.stress import ellipse_stress
from fea.solid.cases import Model, ellipse
from fea.solid.lobes import lobe_stiffness
from fea.solid.peak import SharpEdges, stress_field
from fea.solid.unfold import unfolded
from fea.types import SolidField, Stiffness, StressPeak
from geometry.design import Design
from geometry.meridian import meridian
from geometry.symmetry import sector_of
from pipeline.parts import MeshedPart, PartModel

STRESS_TOLERANCE = 0.005
"""Change of a peak stress over two refinements at which the axisymmetric mesh is fine enough."""


@dataclass(frozen=True)
class RimAnswers:
    """K_b of the lobe cases and the peak stress on the ellipse.

    `K_b_lobes_contact` (the seat may lift off) is None where only the solid model applies: lift-off
    breaks the symmetry that makes that model small.
    """

    K_b_lobes: Stiffness
    K_b_lobes_unsupported: Stiffness
    K_b_lobes_contact: Stiffness | None
    wave_generator_peak: StressPeak


@dataclass(frozen=True)
class SolidRim:
    """The ellipse's field and the lobe cases on one solid model."""

    wave_generator: SolidField
    K_b_lobes: Stiffness
    K_b_lobes_unsupported: Stiffness


def wave_generator_amplitude(design: Design) -> float:
    """w0 = m(z2 − z1)/2 [mm] (contract)."""
    gear = design.gear
    return gear.module_mm * (gear.teeth_circular_spline - gear.teeth_flexspline) / 2


def rim_answers(flexspline: PartModel) -> RimAnswers:
    """By the model that the part's stiffness uses."""
    if flexspline.axisymmetric:
        return _revolved(flexspline)
    rim = solid_rim(flexspline)
    return RimAnswers(rim.K_b_lobes, rim.K_b_lobes_unsupported, None, rim.wave_generator.peak)


def wave_generator_field(flexspline: PartModel) -> SolidField:
    """The ellipse's field for pictures and files; its peak from the model that answers."""
    field = solid_rim(flexspline).wave_generator
    return replace(field, peak=rim_answers(flexspline).wave_generator_peak)


def _revolved(flexspline: PartModel) -> RimAnswers:
    design = flexspline.shop.design
    w0 = wave_generator_amplitude(design)
    wall = design.flexspline.wall_thickness_mm
    tolerance = design.solver.tolerance_pct / 100

    def make() -> RimAnswers:
        with flexspline.shop.progress.stage("wave generator and lobes by Fourier harmonics"):
            outline, material = meridian(design, "flexspline"), flexspline.material
            supported = revolved_lobe_stiffness(outline, material, True, tolerance)
            return RimAnswers(
                supported,
                revolved_lobe_stiffness(outline, material, False, tolerance),
                contact_stiffness(outline, material, supported),
                ellipse_stress(outline, material, w0, wall, STRESS_TOLERANCE).peak,
            )

    inputs: dict[str, Any] = {**flexspline.revolved_key, "w0_mm": w0}
    return flexspline.shop.cache.get("harmonics", inputs, make)[0]


def solid_rim(flexspline: PartModel) -> SolidRim:
    """On the torsion mesh, reflected to a quarter or half."""
    design = flexspline.shop.design
    w0 = wave_generator_amplitude(design)

    def make() -> SolidRim:
        twisted = flexspline.twisted()
        sector = sector_of(design, "flexspline", "ellipse")
        progress = flexspline.shop.progress
        with progress.stage("wave generator and lobes"):
            whole = unfolded(twisted.rim.mesh, sector.degrees)
            model = Model.of(whole, flexspline.material)
            progress.note(f"  {len(whole.cells)} elements, {sector.label} of the part")
            field = stress_field(
                whole,
                ellipse(model, w0).displacement,
                flexspline.material,
                f"wave generator, w0 = {w0:g} mm",
                sharp_edges(flexspline, twisted.rim),
            )
            scale = twisted.stiffness.error_scale
            return SolidRim(
                field,
                lobe_stiffness(model, True, scale, sector.label),
                lobe_stiffness(model, False, scale, sector.label),
            )

    inputs: dict[str, Any] = {**flexspline.torsion_key, "w0_mm": w0}
    return flexspline.shop.cache.get("rim", inputs, make)[0]


def sharp_edges(part: PartModel, meshed: MeshedPart) -> SharpEdges:
    """The stress rule's edges and its distance, one wall thickness."""
    wall = part.shop.design.flexspline.wall_thickness_mm
    return SharpEdges(meshed.sharp_edges, meshed.mesh.sector_deg, wall)
