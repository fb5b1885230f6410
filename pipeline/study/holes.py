"""What bolt holes and keyway do to K, from one solid solve of the study's nominal design.

The fast model has no holes. Its K is multiplied by K_solid/K_axisymmetric of the nominal design, part by
part. The ratio holds there within both models' bounds; elsewhere it is an estimate, so the bounds are
widened by a share of the holes' whole effect as well: they are theorems no longer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.keys import HOLES
from flexspline.geometry.part import PartName
from flexspline.pipeline.analysis import analysis_context
from flexspline.pipeline.part_stiffness import part_stiffness

DRIFT = 0.5
"""Share of the holes' effect by which it may be another elsewhere in the study."""
PART_OF: Mapping[str, PartName] = {"K_b": "flexspline", "K_e": "shaft"}


@dataclass(frozen=True)
class Factor:
    """K with holes over K without, and how far it may be off."""

    value: float
    doubt: float


Holes = Mapping[str, Factor]
"""By "K_b" and "K_e"; a part without holes is absent."""


def pierced(design: Design) -> tuple[str, ...]:
    """ "K_b" and "K_e", as far as that part has bolt holes or a keyway."""
    return tuple(k for k, name in PART_OF.items() if not design.part(name).is_revolved)


def of_holes(keys: Iterable[str]) -> tuple[str, ...]:
    """Those of some design keys that say what the holes or the keyway are."""
    return tuple(k for k in keys if k.endswith(("bolt_count", *HOLES)) or ".keyway." in k)


def with_holes(found: Mapping[str, float], design: Design, holes: Holes) -> dict[str, float]:
    """Figures with K and its bounds corrected where the part has holes, and the factor beside them."""
    out = dict(found)
    for name in pierced(design):
        if name not in holes or f"{name}_Nm_per_rad" not in found:
            continue
        factor = holes[name]
        bounds = f"{name}_bounds_Nm_per_rad"
        out[f"{name}_Nm_per_rad"] *= factor.value
        out[f"{bounds}[0]"] *= factor.value - factor.doubt
        out[f"{bounds}[1]"] *= factor.value + factor.doubt
        out[f"{name}_bounds_guaranteed"] = 0.0
        out[f"{name}_holes_factor"] = factor.value
    return out


def holes_of(
    design: Design,
    torsion: Callable[[Design, PartName], tuple[float, float, float]],
    say: Callable[[str], None],
) -> Holes:
    """The factors of a nominal design; `torsion` gives K and bounds of a part without its holes.

    Where the solid solve fails there is none, and `say` is told.
    """
    context = analysis_context(design)
    found = {}
    for figure in pierced(design):
        name = PART_OF[figure]
        part = context.part(name)
        say(
            f"the {name} of the nominal design with the solid model, for what its holes do to {figure}"
        )
        try:
            solid = part_stiffness(part)
        except ComputationError as fault:
            say(f"{figure} stays that of the {name} without holes: {fault}")
            continue
        K, low, high = torsion(design, name)
        value = min(1.0, solid.K_Nm_per_rad / K)  # less material never makes a part stiffer
        ends = (solid.lower_Nm_per_rad / high, solid.upper_Nm_per_rad / low)
        doubt = max(abs(end - value) for end in ends) + DRIFT * abs(1 - value)
        found[figure] = Factor(value, doubt)
    return found
