"""dK/dp of every dimension of one design, found in two ways that share no mesh.

First from the energy with the field held (`fea.axisymmetric.shape_slope`), from one solution. Then from
K solved anew on either side, with two step sizes and Richardson's extrapolation. Both by the axisymmetric
model: bolt holes and keyway are left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fea.axisymmetric.shape_slope import moved_stiffness, twist
from fea.axisymmetric.torsion import torsional_stiffness
from fea.types import Elastic
from geometry.design import Design
from geometry.errors import DesignError
from geometry.meridian import meridian
from pipeline.backlash import ARCSEC_PER_RAD
from pipeline.diagnosis.specimens.designs import lengths, with_values, without_holes
from pipeline.parts import DRIVEN
from pipeline.study.evaluate import with_equivalent_ring

HELD_STEP = 1e-4
"""Of the dimension: the energy's difference is smooth, so only rounding limits the step."""
SOLVED_STEP = 0.04
"""Of the dimension: K is known to half of K_TOLERANCE only, and its difference must stand above that."""
K_TOLERANCE = 3e-4
ENERGY_TOLERANCE = 1e-3
NARROWER = 0.25
TRIES = 4


@dataclass(frozen=True)
class Slope:
    """One dimension's influence on its part's K.

    Attributes
    ----------
    held : dK/dp from the energy with the field held [N·m/rad per mm]; None where the outline changes
        its corners within the step.
    solved : dK/dp from differences of K solved anew; None where there is no room on both sides.
    solved_error : what the bounds of K and the extrapolation leave open of it.
    K_Nm_per_rad : of the part, hole-free.
    backlash_arcsec_per_mm : d(wind-up of the part between −T_L and +T_L)/dp.
    """

    key: str
    part: str
    value_mm: float
    held: float | None
    solved: float | None
    solved_error: float
    K_Nm_per_rad: float
    backlash_arcsec_per_mm: float

    @property
    def best(self) -> float:
        """The held one where there is one."""
        return self.held if self.held is not None else (self.solved or 0.0)

    @property
    def elasticity(self) -> float:
        """% of K per % of the dimension."""
        return self.best * self.value_mm / self.K_Nm_per_rad

    @property
    def agree(self) -> bool | None:
        """Whether both ways meet within the second's error and a percent of K per 100 %."""
        if self.held is None or self.solved is None:
            return None
        slack = self.solved_error + 0.01 * self.K_Nm_per_rad / self.value_mm
        return abs(self.held - self.solved) <= slack


def sensitivities(design: Design, say: Callable[[str], None]) -> tuple[Slope, ...]:
    """Of every length above 0 of both parts, the strongest first within a part.

    Raises
    ------
    DesignError, ComputationError
    """
    plain = without_holes(with_equivalent_ring(design))
    found: list[Slope] = []
    for part in ("flexspline", "shaft"):
        own = plain.shaft_material if part == "shaft" else plain.material.flexspline
        material = Elastic.of(own)
        outline = meridian(plain, part)
        solved = twist(outline, material, DRIVEN[part], ENERGY_TOLERANCE)

        def K(values: dict[str, float], part: str = part, material: Elastic = material) -> float:
            shape = meridian(with_values(plain, values), part)
            bounds = torsional_stiffness(shape, material, DRIVEN[part], K_TOLERANCE)
            return bounds.K_Nm_per_rad

        here = K({})
        slopes = []
        for key, p in lengths(plain, part).items():
            say(f"dK/dp of {key}")
            held = _central(
                lambda v, part=part, solved=solved: moved_stiffness(  # type: ignore[misc]
                    solved, meridian(with_values(plain, v), part)
                ),
                key, p, HELD_STEP,
            )  # fmt: skip
            again, error = _richardson(K, key, p, here)
            best = held if held is not None else (again or 0.0)
            windup = -2 * design.load.torque_Nm / here**2 * best * ARCSEC_PER_RAD
            slopes.append(Slope(key, part, p, held, again, error, here, windup))
        found += sorted(slopes, key=lambda s: -abs(s.elasticity))
    return tuple(found)


def _central(
    K: Callable[[dict[str, float]], float], key: str, p: float, share: float
) -> float | None:
    h = share * p
    try:
        return (K({key: p + h}) - K({key: p - h})) / (2 * h)
    except (DesignError, ValueError):
        return None


def _richardson(
    K: Callable[[dict[str, float]], float], key: str, p: float, here: float
) -> tuple[float | None, float]:
    """Central differences over h and h/2, extrapolated to h = 0; and what may be wrong with them."""
    share = SOLVED_STEP
    for _ in range(TRIES):
        wide, close = _central(K, key, p, share), _central(K, key, p, share / 2)
        if wide is not None and close is not None:
            noise = 5 / 3 * K_TOLERANCE * here / (share * p)  # K's doubt on each, times the weights
            return (4 * close - wide) / 3, noise + abs(close - wide) / 3
        share *= NARROWER
    return None, 0.0
