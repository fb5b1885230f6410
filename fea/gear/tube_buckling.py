"""Torque at which the tube between ring and bottom buckles, by Donnell's closed form.

Donnell, Stability of thin-walled tubes under torsion, NACA Report 479 (1933); in this form in Roark's
Formulas for Stress and Strain, 7th ed., table 15.2. Tests lie below it: their lower edge is 0.67 of the
theory of hinged ends (NASA SP-8007). Diaphragm and ring clamp the perfect tube (benchmarks/tube_buckling.py).
Elastic, and without the oval shape that the wave generator gives the tube.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt
from typing import Literal

from flexspline.fea.types import NMM_PER_NM, Elastic
from flexspline.geometry.shapes import Flexspline

LOWER_EDGE_OF_TESTS = 0.67
"""Buckling torque in tests over theory, lower bound: γ^(3/4) of NASA SP-8007, cylinders in torsion."""
YIELD_SHEAR_OVER_E = 0.01
"""Largest shear stress at yield over Young's modulus: steels reach 0.006, plastics about this value. Without
this limit a tube of 1.2 mm length and 0.4 mm wall would buckle at 0.5."""
EndFixity = Literal["hinged", "clamped"]
TERMS: dict[EndFixity, tuple[float, float, float]] = {
    "hinged": (1.27, 9.64, 0.466),
    "clamped": (-2.39, 96.9, 0.605),
}
"""Coefficients a, b, c of a + √(b + c H^1.5)."""


@dataclass(frozen=True)
class Tube:
    """Middle radius, wall, free length [mm]."""

    radius: float
    wall: float
    length: float
    material: Elastic

    @classmethod
    def between(cls, flexspline: Flexspline, material: Elastic) -> Tube | None:
        """Diaphragm and the ring's shoulder; None where they meet."""
        length = flexspline.shoulder_start - flexspline.diaphragm_thickness_mm
        wall = flexspline.wall_thickness_mm
        if length <= wall:
            return None
        return cls(flexspline.inner_radius + wall / 2, wall, length, material)

    def torque_Nm(self, ends: EndFixity) -> float:
        """Of a perfect tube."""
        nu = self.material.poissons_ratio
        H = sqrt(1 - nu * nu) * self.length**2 / (self.wall * self.radius)
        a, b, c = TERMS[ends]
        bending = self.material.plane_strain_MPa * (self.wall / self.length) ** 2
        stress = bending * (a + sqrt(b + c * H**1.5))
        return stress / self.stress_MPa(1.0)

    @property
    def lower_edge_Nm(self) -> float:
        """Of a real tube: the factor belongs to the theory of hinged ends, though tests clamp them."""
        return LOWER_EDGE_OF_TESTS * self.torque_Nm("hinged")

    @property
    def yields_first(self) -> bool:
        """Whether hardly any material is elastic up to there: so it is with a short or a thick tube."""
        limit_MPa = YIELD_SHEAR_OVER_E * self.material.youngs_modulus_MPa
        return self.stress_MPa(self.lower_edge_Nm) > limit_MPa

    def stress_MPa(self, torque_Nm: float) -> float:
        """Shear in the wall."""
        return torque_Nm * NMM_PER_NM / (2 * pi * self.radius**2 * self.wall)
