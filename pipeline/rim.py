"""What the lobes and the wave generator do to the flexspline's rim: axisymmetric or solid."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from fea.axisymmetric.contact import contact_stiffness
from fea.axisymmetric.lobes import lobe_stiffness as revolved_lobe_stiffness
from fea.axisymmetric.stress import ellipse_stress
from fea.solid.cases import Model
from fea.solid.lobes import lobe_stiffness
from fea.solid.unfold import unfolded
from fea.types import SolidField, Stiffness, StressPeak
from geometry.meridian import meridian
from geometry.symmetry import sector_of
from pipeline.parts import PartModel
from pipeline.rim_stress import solid_ellipse

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
class SolidLobes:
    """K_b of the lobe cases on a solid model, without and with the seat free to move."""

    K_b_lobes: Stiffness
    K_b_lobes_unsupported: Stiffness


def rim_answers(flexspline: PartModel) -> RimAnswers:
    """By the model that the part's stiffness uses."""
    if flexspline.axisymmetric:
        return _revolved(flexspline)
    lobes = _solid_lobes(flexspline)
    peak = solid_ellipse(flexspline).peak
    return RimAnswers(lobes.K_b_lobes, lobes.K_b_lobes_unsupported, None, peak)


def wave_generator_field(flexspline: PartModel) -> SolidField:
    """The ellipse's field for pictures and files; its peak from the model that answers."""
    field = solid_ellipse(flexspline)
    if not flexspline.axisymmetric:
        return field
    return replace(field, peak=_revolved(flexspline).wave_generator_peak)


def _revolved(flexspline: PartModel) -> RimAnswers:
    design = flexspline.shop.design
    w0 = design.gear.centre_distance_mm
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


def _solid_lobes(flexspline: PartModel) -> SolidLobes:
    """On the torsion mesh, reflected to a quarter or half."""
    shop = flexspline.shop
    sector = sector_of(shop.design, "flexspline", "lobes")

    def make() -> SolidLobes:
        twisted = flexspline.twisted()
        with shop.progress.stage("lobes"):
            whole = unfolded(twisted.rim.mesh, sector.degrees)
            shop.progress.note(f"  {len(whole.cells)} elements, {sector.label} of the part")
            model = Model.of(whole, flexspline.material)
            scale = twisted.stiffness.error_scale
            return SolidLobes(
                lobe_stiffness(model, True, scale, sector.label),
                lobe_stiffness(model, False, scale, sector.label),
            )

    return shop.cache.get("lobes", flexspline.torsion_key, make)[0]
