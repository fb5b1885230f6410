"""The fast model: bodies of revolution that replace a design's parts, solved on the meridian.

K_b of a flexspline with bolt holes lies between those of two bodies of revolution (`pipeline.enclosure`).
Everything else leaves holes and keyway out, and drawn teeth are their plain ring. Every answer is
proportional to Young's modulus or to a load: parts are solved for 1 GPa, 1 mm and 1 N·m and remembered, so
another material, torque or clearance costs nothing, and a change of one part leaves the other.
`relative_width` is the distance of K's bounds that is asked for, over K: ± half of it. Stress:
`pipeline.revolved_stress`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

from flexspline.fea.axisymmetric.contact import contact_stiffness
from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.deadline import NO_DEADLINE
from flexspline.fea.types import Elastic, Stiffness
from flexspline.geometry.design import Design
from flexspline.geometry.keys import without_holes
from flexspline.geometry.material import Material
from flexspline.geometry.part import Part
from flexspline.geometry.part_name import PartName
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.drawn_teeth import of_toothed
from flexspline.pipeline.enclosure import two_bodies
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.refining import Refining
from flexspline.pipeline.rim_case import RimSolve, free_rim, held_rim
from flexspline.pipeline.storage import cache_folder

KEPT_PARTS = 512
"""Solved parts remembered: enough for a study's worker, and to go back and forth with a slider."""


BEGUN = 2
"""Of them those that may be refined on: both bodies of the newest part, for they hold their meshes."""
FIRST_HALF_WIDTH = 0.04
"""Of a first answer's bounds, relative. On one mesh, its estimate times 2.7, those of 6 of 207 extreme
designs did not hold, of 5.8 % and more; so far, times 4, all hold, K is within 2.4 %, and one mesh is enough
for 134."""


def revolved(design: Design) -> Design:
    """Return the bodies of revolution that stand for the design: no holes, teeth as their plain ring.

    Raises
    ------
    DesignError : the plain ring of drawn teeth does not fit.
    """
    return without_holes(with_equivalent_ring(design))


def with_equivalent_ring(design: Design) -> Design:
    """Return the design with the plain ring that stands for drawn teeth; errors as `revolved`."""
    if design.flexspline.teeth == "none":
        return design
    cache = Cache(cache_folder(), lambda line: None)  # what matters comes as an error
    return AnalysisContext(design, cache, Progress()).part("flexspline").context.design


def stiffness(design: Design, name: PartName, relative_width: float) -> Stiffness:
    """Return K_b of the load case "uniform", or K_e, of a design's part [N·m/rad].

    Raises
    ------
    DesignError : the plain ring of drawn teeth does not fit.
    ComputationError : as `torsion`.
    """
    part = with_equivalent_ring(design).part(name)
    K = torsion(part, relative_width)
    return K if part.shape == design.part(name).shape else of_toothed(K)


def torsion(part: Part, relative_width: float) -> Stiffness:
    """Return K_b of the load case "uniform", or K_e [N·m/rad].

    `relative_width` is that of each body of revolution. What misses it has its reason in `shortfall`, here
    and below.

    Raises
    ------
    NestingError
    ComputationError : no mesh, or no solution.
    """
    return _of_holed(part, lambda body: _torsion(body, relative_width))


def lobes(part: Part, supported: bool, relative_width: float) -> Stiffness:
    """Return K_b under the lobe load; `supported`: the seat may not move radially. Errors as `torsion`."""
    return rim(part, held_rim if supported else free_rim, relative_width)


def rim(part: Part, solve: RimSolve, relative_width: float) -> Stiffness:
    """Return K_b of a load case of the rim. Errors as `torsion`."""
    return _of_holed(part, lambda body: _rim(body, solve, relative_width))


def first_rim(part: Part, solve: RimSolve, relative_width: float) -> Stiffness:
    """Return `rim` on each body's first mesh that gives K to FIRST_HALF_WIDTH; ask for it before `rim`."""

    def enough(K: Stiffness) -> bool:
        return K.half_width <= FIRST_HALF_WIDTH

    return _of_holed(part, lambda body: _begun(body, solve, relative_width).until(enough))


def contact(part: Part, relative_width: float) -> Stiffness:
    """Return K_b under the lobe load, the seat resting on the wave generator; errors as `torsion`."""
    return _of_holed(part, lambda body: _contact(body, relative_width))


def _of_holed(part: Part, solve: Callable[[Part], Stiffness]) -> Stiffness:
    """Of a flexspline between its two bodies; of a shaft without its holes, then no theorem."""

    def solved(body: Part) -> Stiffness:
        return solve(of_1_GPa(body)).times(body.material.youngs_modulus_GPa)

    if part.name == "flexspline" and part.bolts is not None:
        return two_bodies(part, solved).enclosure()
    K = solved(part.without_holes())
    return replace(K, guaranteed=K.guaranteed and part.is_revolved)


def of_1_GPa(part: Part) -> Part:
    """Return the part that is solved and kept: the same shape and Poisson's ratio."""
    nu = part.material.poissons_ratio
    return replace(part, material=Material(name="1 GPa", youngs_modulus_GPa=1.0, poissons_ratio=nu))


def _elastic(part: Part) -> Elastic:
    return Elastic.of(part.material)


@lru_cache(maxsize=KEPT_PARTS)
def _torsion(part: Part, relative_width: float) -> Stiffness:
    return torsional_stiffness(part.meridian, _elastic(part), part.driven, relative_width)


@lru_cache(maxsize=KEPT_PARTS)
def _rim(part: Part, solve: RimSolve, relative_width: float) -> Stiffness:
    return _begun(part, solve, relative_width).last()


@lru_cache(maxsize=BEGUN)
def _begun(part: Part, solve: RimSolve, relative_width: float) -> Refining[Stiffness]:
    return Refining(solve(part.meridian, _elastic(part), relative_width, NO_DEADLINE))


@lru_cache(maxsize=KEPT_PARTS)
def _contact(part: Part, relative_width: float) -> Stiffness:
    return contact_stiffness(part.meridian, _elastic(part), _rim(part, held_rim, relative_width))
