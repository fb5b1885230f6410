"""Effect of the shaft's bolt holes and keyway on K_e, from one solid solve of the nominal design.

The fast model's shaft has none. The solid model of the nominal design tells how much compliance they add, as
a share of the compliance L/(G·J) of the pieces that they cut: the flange, and the keyway's length of the last
segment. Every design's pieces take that share more. At the nominal design K_e is the solid model's, within
both models' bounds, whatever the modulus; where the study changes the shaft it is an estimate, so the bounds
are widened by a share of the holes' whole effect as well. They are theorems no longer. (The flexspline needs
no such correction: every design's K_b has bounds of its own, `pipeline.enclosure`.)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from flexspline.fea.shortfall import missing_because
from flexspline.fea.types import NMM_PER_NM, Elastic, Stiffness
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.keys import HOLES
from flexspline.geometry.shaft_shape import ShaftSegment
from flexspline.geometry.tube import polar_moment_mm4
from flexspline.pipeline.analysis import analysis_context
from flexspline.pipeline.part_stiffness import part_stiffness
from flexspline.pipeline.study.figures import stiffness_keys

HOLE_EFFECT_DRIFT = 0.5
"""Share of the holes' effect by which it may be another elsewhere in the study."""


@dataclass(frozen=True)
class UnknownEffect:
    """The solid solve of the nominal design failed: K_e is that without holes and keyway.

    Attributes
    ----------
    reason : why, in plain words.
    passing : whether more time or memory would have found the effect.
    """

    reason: str
    passing: bool = False


@dataclass(frozen=True)
class HolesEffect:
    """The effect of the nominal design's holes and keyway on its K_e.

    Attributes
    ----------
    share : compliance that they add, over that of the pieces that they cut.
    doubt : of K_e over itself, by both models' bounds of the nominal design.
    drift : share of the effect by which it may be another in other designs of the study.
    """

    share: float
    doubt: float
    drift: float

    def factor(self, design: Design, K_e_Nm_per_rad: float) -> tuple[float, float]:
        """Return K_e with holes over `K_e_Nm_per_rad` without, and its possible error."""
        value = 1 / (1 + self.share * cut_compliance(design) * K_e_Nm_per_rad)
        return value, self.doubt + self.drift * (1 - value)


def cut_compliance(design: Design) -> float:
    """Return L/(G·J) of the shaft's pieces with holes and keyway, as if uncut [rad/(N·m)].

    Source: torsion of a round tube.
    """
    shaft, material = design.shaft, Elastic.of(design.part("shaft").material)

    def of(segment: ShaftSegment, length_mm: float) -> float:
        polar_mm4 = polar_moment_mm4(segment.outer_diameter_mm / 2, segment.inner_diameter_mm / 2)
        return length_mm / (material.mu * polar_mm4) * NMM_PER_NM

    first, last = shaft.segment[0], shaft.segment[-1]
    holes = of(first, first.length_mm) if shaft.bolt_count else 0.0
    return holes + (of(last, shaft.keyway.length_mm) if shaft.keyway is not None else 0.0)


def pierced(design: Design) -> bool:
    """Whether the shaft has bolt holes or a keyway."""
    return not design.part("shaft").is_revolved


def unfollowed(keys: Iterable[str]) -> tuple[str, ...]:
    """Return those design keys that the fast model's shaft lacks: its holes and its keyway."""
    of_shaft = (k for k in keys if k.startswith("shaft."))
    return tuple(k for k in of_shaft if k.endswith(("bolt_count", *HOLES)) or ".keyway." in k)


def drifts(keys: Iterable[str]) -> bool:
    """Whether some of the design keys change the ratio: the shaft's dimensions or Poisson's ratio."""
    return any(k.startswith("shaft.") or k.endswith(".poissons_ratio") for k in keys)


def with_holes(
    solved: Mapping[str, float], design: Design, effect: HolesEffect
) -> dict[str, float]:
    """Return K_e and its bounds corrected, and the factor beside them."""
    K, low, high = stiffness_keys("K_e")
    value, doubt = effect.factor(design, solved[K])
    return {
        K: solved[K] * value,
        low: solved[low] * (value - doubt),
        high: solved[high] * (value + doubt),
        "K_e_bounds_guaranteed": 0.0,
        "K_e_holes_factor": value,
    }


def holes_of(
    design: Design,
    K_e: Callable[[Design], Stiffness],
    say: Callable[[str], None],
    drift: float = HOLE_EFFECT_DRIFT,
) -> HolesEffect | UnknownEffect | None:
    """Return the effect for a nominal design; `K_e` is the fast model's, without the holes.

    `drift`: share of the holes' effect, as HOLE_EFFECT_DRIFT; 0 where the study leaves the shaft as it is.
    None where the shaft has none.

    Raises
    ------
    NestingError : one of two models of the shaft is wrong.
    """
    if not pierced(design):
        return None
    say("the shaft of the nominal design with the solid model, for what its holes do to K_e")
    try:
        fast = K_e(design)
        solid = part_stiffness(analysis_context(design).part("shaft"))
    except (ComputationError, MemoryError) as fault:
        why = missing_because(fault)
        say(f"K_e stays that of the shaft without holes: {why}")
        return UnknownEffect(why.words, why.of_the_machine)
    value = min(1.0, solid.K_Nm_per_rad / fast.K_Nm_per_rad)  # less material is never stiffer
    ends = (
        solid.lower_Nm_per_rad / fast.upper_Nm_per_rad,
        solid.upper_Nm_per_rad / fast.lower_Nm_per_rad,
    )
    share = (1 / value - 1) / (fast.K_Nm_per_rad * cut_compliance(design))
    return HolesEffect(share, max(abs(end - value) for end in ends), drift)
