"""Drawn teeth: the design with the equivalent plain ring, which every model then uses."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from flexspline.fea.toothed_ring.equivalent import EquivalentRing, equivalent_ring
from flexspline.fea.types import Stiffness
from flexspline.geometry.checks import check
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.tooth import tooth_cell
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.progress import Progress


def ring_of(design: Design, cache: Cache, progress: Progress) -> EquivalentRing | None:
    """Return the plain ring that stands for the teeth; None where the design draws none."""
    f, gear = design.flexspline, design.gear
    if f.teeth == "none":
        return None
    poissons_ratio = design.material.flexspline.poissons_ratio

    def make() -> EquivalentRing:
        with progress.stage("teeth"):
            return equivalent_ring(tooth_cell(design), poissons_ratio)

    inputs: dict[str, Any] = {
        "inner_mm": f.inner_radius,
        "rim_mm": f.ring_thickness_mm,
        "flank": f.tooth_flank,
        "module_mm": gear.module_mm,
        "teeth": gear.teeth_flexspline,
        "pressure_angle_deg": gear.pressure_angle_deg,
        "poissons_ratio": poissons_ratio,
    }
    return cache.get("teeth", inputs, make)[0]


def with_plain_ring(design: Design, ring: EquivalentRing) -> Design:
    """Return the design with a plain ring as stiff against bending as its toothed one.

    Raises
    ------
    DesignError : the thicker ring, with its 45° shoulder, does not fit the part.
    """
    changes = {"ring_thickness_mm": ring.bending_mm, "teeth": "none"}
    undrawn = design.gear.model_copy(update={"flanks": "plain"})
    plain = design.model_copy(
        update={"flexspline": design.flexspline.model_copy(update=changes), "gear": undrawn}
    )
    try:
        check(plain)
    except DesignError as error:
        raise DesignError(
            "flexspline.teeth",
            design.flexspline.teeth,
            f"stands for a plain ring of {ring.bending_mm:.4g} mm that does not fit: {error}; "
            'teeth = "none" works',
        ) from None
    return plain


def of_toothed(of_plain: Stiffness) -> Stiffness:
    """Return K of the part with teeth: the same numbers as with its plain ring, but only estimated.

    The bounds enclose the plain part's K. That its ring is as stiff as the toothed one is a model, and no
    theorem says how far off it is.
    """
    of_plain = replace(of_plain, proven_Nm_per_rad=None)
    if not of_plain.guaranteed:
        return of_plain
    method = f"{of_plain.method}; of the part with the plain ring that stands for the teeth"
    return replace(of_plain, guaranteed=False, method=method)
