"""What bolt holes and keyway of the shaft do to K_e, from one solid solve of the study's nominal design.

The fast model's shaft has none. Its K_e is multiplied by K_solid/K_axisymmetric of the nominal design. The
ratio holds there within both models' bounds, whatever the modulus; where the study changes the shaft it is
an estimate, so the bounds are widened by a share of the holes' whole effect as well. They are theorems no
longer. (The flexspline needs no such factor: every design's K_b has bounds of its own,
`pipeline.enclosure`.)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from flexspline.fea.types import Stiffness
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.keys import HOLES
from flexspline.pipeline.analysis import analysis_context
from flexspline.pipeline.part_stiffness import part_stiffness

DRIFT = 0.5
"""Share of the holes' effect by which it may be another elsewhere in the study."""


@dataclass(frozen=True)
class Factor:
    """K_e with holes over K_e without, and how far it may be off."""

    value: float
    doubt: float


def pierced(design: Design) -> bool:
    """Whether the shaft has bolt holes or a keyway."""
    return not design.part("shaft").is_revolved


def unfollowed(keys: Iterable[str]) -> tuple[str, ...]:
    """Those of some design keys that the fast model's shaft lacks: its holes and its keyway."""
    of_shaft = (k for k in keys if k.startswith("shaft."))
    return tuple(k for k in of_shaft if k.endswith(("bolt_count", *HOLES)) or ".keyway." in k)


def drifts(keys: Iterable[str]) -> bool:
    """Whether some of the design keys move the ratio: the shaft's dimensions or Poisson's ratio."""
    return any(k.startswith("shaft.") or k.endswith(".poissons_ratio") for k in keys)


def with_holes(found: Mapping[str, float], factor: Factor) -> dict[str, float]:
    """Figures with K_e and its bounds corrected, and the factor beside them."""
    return {
        **found,
        "K_e_Nm_per_rad": found["K_e_Nm_per_rad"] * factor.value,
        "K_e_bounds_Nm_per_rad[0]": found["K_e_bounds_Nm_per_rad[0]"] * (factor.value - factor.doubt),
        "K_e_bounds_Nm_per_rad[1]": found["K_e_bounds_Nm_per_rad[1]"] * (factor.value + factor.doubt),
        "K_e_bounds_guaranteed": 0.0,
        "K_e_holes_factor": factor.value,
    }  # fmt: skip


def holes_of(
    design: Design,
    K_e: Callable[[Design], Stiffness],
    say: Callable[[str], None],
    drift: float = DRIFT,
) -> Factor | None:
    """The factor of a nominal design; `K_e` is the fast model's, without the holes.

    `drift`: share of the holes' effect, as `DRIFT`; 0 where the study leaves the shaft as it is. None where
    the shaft has none, or where the solid solve fails, which `say` is told.
    """
    if not pierced(design):
        return None
    say("the shaft of the nominal design with the solid model, for what its holes do to K_e")
    try:
        solid = part_stiffness(analysis_context(design).part("shaft"))
    except ComputationError as fault:
        say(f"K_e stays that of the shaft without holes: {fault}")
        return None
    fast = K_e(design)
    value = min(1.0, solid.K_Nm_per_rad / fast.K_Nm_per_rad)  # less material is never stiffer
    ends = (
        solid.lower_Nm_per_rad / fast.upper_Nm_per_rad,
        solid.upper_Nm_per_rad / fast.lower_Nm_per_rad,
    )
    return Factor(value, max(abs(end - value) for end in ends) + drift * abs(1 - value))
