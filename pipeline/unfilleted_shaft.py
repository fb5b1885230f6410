"""A shaft whose fillets cannot be swept: its K lies between those of two shafts without fillets.

Fillets of a few thousandths of the diameter ask for layers, rings and elements as thin, or leave no mesh at
all; they hardly change K. Large ones do, and fTetWild is tried before they are left out.
"""

from __future__ import annotations

from dataclasses import replace

from flexspline.fea.deadline import Deadline
from flexspline.fea.errors import SolidError, TooManyElementsError
from flexspline.fea.types import MET, Shortfall, SolidField
from flexspline.geometry.errors import ComputationError
from flexspline.geometry.nested import has_unfilleted_bodies, unfilleted_bodies
from flexspline.geometry.part import Part
from flexspline.pipeline.enclosure import Names, between
from flexspline.pipeline.part_meshes import SWEEPS
from flexspline.pipeline.parts import PartModel
from flexspline.pipeline.revolved import torsion
from flexspline.pipeline.solid_torsion import SOLID_SECONDS, TwistedPart, twisted

LESS, MORE = "the shaft without its fillets", "the shaft whose steps are moved by the fillet"
UNFILLETED_BODY_SHARE = 0.7
"""Of the tolerance, for each of the two shafts: fillets of 0.3 % of the diameter leave ± 0.01 to 0.2 %."""
FILLETS = "its fillets"
MOST_WITH_FILLETS = 60_000
"""Elements of the coarsest first mesh: 270 000 unknowns, 15 s of the processor and more. A shaft with fillets
of 0.1 % of its diameter had 52 149, of 0.6 % 40 269; two without, of 36 561 and 37 857, take longer."""
REVOLVED_WIDTH, SMALL_DIFFERENCE = 2e-3, 0.01
"""Of the bounds of K of both shafts without holes, over K; and half of what they may differ by where fTetWild
is not tried first. With fillets of 5 to 10 % of the diameter five random shafts were known to ± 8 to 15 % so,
by fTetWild to ± 0.2 to 0.6 % in as much time; those of 0.3 % differ by 0.01 to 3 %."""
REMEDY = "a stated solver.edge_length_mm meshes its fillets, however long that takes"
DIFFER = Shortfall(f"{LESS} and {MORE} differ by more")


def twisted_shaft(model: PartModel, tolerance: float) -> TwistedPart:
    """Turn a shaft by 1 rad: by sweeps, else between two without fillets, else by fTetWild.

    Where those two differ by much, fTetWild comes before them.

    Raises
    ------
    SolidError, MemoryError
    """
    if not _hardly_differ(model, tolerance):
        try:
            return twisted(model, tolerance)
        except SolidError as fault:
            model.context.progress.note(f"  {model.name}: its fillets are left out, {fault}")
        return _between_shafts(model, tolerance)
    try:
        return twisted(model, tolerance, SWEEPS, MOST_WITH_FILLETS)
    except TooManyElementsError as fault:
        why = f"a mesh with them has {fault.elements:.0f} elements or more"
    except SolidError as fault:
        why = str(fault)
    model.context.progress.note(f"  {model.name}: its fillets are left out, {why}")
    try:
        return _between_shafts(model, tolerance)
    except SolidError as fault:
        model.context.progress.note(f"  {model.name}: fTetWild makes all meshes, {fault}")
    return twisted(model, tolerance, ("tetwild",))


def marked_unfilleted(field: SolidField) -> SolidField:
    """Return a cut body's field as one of the shaft; its peak is compared with no limit."""
    peak = field.peak
    excluded = f"{peak.excluded}, and {FILLETS}, which the mesh leaves out"
    judged = replace(peak, excluded=excluded, at_excluded_border=True, left_out=FILLETS)
    return replace(field, peak=judged, left_out=FILLETS)


def may_leave_fillets_out(model: PartModel) -> bool:
    """Whether `twisted_shaft` may answer: no mesher and no edge length is asked for."""
    free = model.mesher == "auto" and not model.states_edges
    return free and has_unfilleted_bodies(model.part)


def _hardly_differ(model: PartModel, tolerance: float) -> bool:
    """Whether fillets do little to K, by the bodies of revolution that both shafts would be without holes."""
    bodies = unfilleted_bodies(model.part)
    try:
        less, more = (
            torsion(body.without_holes(), REVOLVED_WIDTH) for body in (bodies.cut, bodies.whole)
        )
    except ComputationError:
        return False
    difference = more.K_Nm_per_rad / less.K_Nm_per_rad - 1
    return difference / 2 <= max(tolerance, SMALL_DIFFERENCE)


def _between_shafts(model: PartModel, tolerance: float) -> TwistedPart:
    bodies, share = unfilleted_bodies(model.part), UNFILLETED_BODY_SHARE * tolerance
    both = Deadline(SOLID_SECONDS)

    def solved(part: Part, seconds: float) -> TwistedPart:
        return twisted(replace(model, part=part), share, SWEEPS, seconds=seconds)

    less = solved(bodies.cut, SOLID_SECONDS / 2)
    more = solved(bodies.whole, max(SOLID_SECONDS / 2, SOLID_SECONDS - both.elapsed()))
    names = Names(LESS, MORE, "solid", model.sector.label)
    enclosure = between(less.stiffness, more.stiffness, names)
    levels, short = less.stiffness.levels, enclosure.half_width > tolerance
    shortfall = MET
    if short:
        difference = more.stiffness.K_Nm_per_rad / less.stiffness.K_Nm_per_rad - 1
        why = DIFFER if difference / 2 > tolerance else enclosure.shortfall or DIFFER
        shortfall = replace(why, words=f"{why}; {REMEDY}")
    return replace(
        less,
        stiffness=replace(
            enclosure,
            method=f"K is the middle of its bounds; {enclosure.method}",
            symmetry=f"{enclosure.symmetry}, two shafts",
            levels=levels,
            shortfall=shortfall,
        ),
        change=None,
        without_fillets=True,
    )
