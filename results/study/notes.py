"""Notes in a study's report on its limits."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import inf

from flexspline.geometry.above_zero import ABOVE_ZERO
from flexspline.geometry.design import Design
from flexspline.geometry.gear_assumptions import gear_assumptions
from flexspline.geometry.listed import joined
from flexspline.geometry.part_name import PART_NAMES
from flexspline.geometry.percent import percent, percent_change
from flexspline.pipeline.gear.gear_curve import T1_SHARE, T2_SHARE
from flexspline.pipeline.stress_limits import ON_ELLIPSE, ON_HALF_SEAT, PART_OF
from flexspline.pipeline.study.evaluate import STUDY_LOBE_WIDTH, STUDY_TORSION_WIDTH
from flexspline.pipeline.study.figures import stiffness_keys
from flexspline.pipeline.study.holes import HOLE_EFFECT_DRIFT, drifts, pierced
from flexspline.pipeline.study.result import StudyResult
from flexspline.results.peaks import BORDER, MEANING, at_border
from flexspline.results.sentences import sentence
from flexspline.results.study.design_table import MARK, marked_figures
from flexspline.results.study.labels import LISTED_DESIGNS, entry
from flexspline.results.study.why import unfollowed

PRELOAD = "preload_tooth_force_N"
LATE_SHARE = 0.25
"""Of a search's designs, the last: what words call a quarter."""
LEAST_MOVE = STUDY_LOBE_WIDTH / 2
"""Of the best figure: half of what bounds of K are wide in a study."""
PEAKS = tuple(f"{name}_mises_MPa" for name in (*PART_OF, ON_HALF_SEAT))


def notes(result: StudyResult, of_designs: Sequence[str] = ()) -> list[str]:
    """Sentences of the section "Scope and limits"; `of_designs`: warnings of the first and the best."""
    sentences = [
        f"Fast model: bodies of revolution of the same meridian, without bolt holes and keyway; bounds "
        f"of K are at most {100 * STUDY_TORSION_WIDTH:g} % apart, for lobes "
        f"{100 * STUDY_LOBE_WIDTH:g} %.",
        *_holes(result),
        _mass(result.study.design),
    ]
    sentences += map(sentence, unsettled(result))
    sentences += map(sentence, unmoved(result))
    sentences += _borders(result)
    sentences += _whole_gear(result)
    sentences += map(sentence, of_designs)
    if not result.verified:
        requested = result.study.file.run.verify
        why = (
            f"no design meets every constraint; {requested} requested"
            if requested
            else "run.verify = 0"
        )
        sentences.append(f"No design was solved again with the solid model ({why}).")
    return sentences


def _borders(result: StudyResult) -> Iterable[str]:
    """Which peaks hang on the stress rule, in how many designs, and what the study does with them."""
    in_table = marked_figures(result)
    for key in PEAKS:
        rows = [r for r in result.built if key in r.outcome.figures]
        if count := sum(at_border(key, r.outcome.figures) for r in rows):
            used = _used(result, key)
            name = f"{entry(key).name} ({used})" if used else entry(key).name
            mark = f" ({MARK})" if key in in_table else ""
            meaning = "" if mark else f": {MEANING}"
            advice = _advice(result, key)
            yield f"{name}: in {count} of {len(rows)} designs {BORDER}{mark}{meaning}{advice}."


def border_warnings(result: StudyResult) -> Iterable[str]:
    """Lines for the terminal: objectives and constraints on such peaks."""
    for key in PEAKS:
        count = sum(at_border(key, r.outcome.figures) for r in result.built)
        if count and (used := _used(result, key)):
            yield (
                f"{entry(key).name} ({used}): in {count} of {len(result.built)} designs {BORDER}: "
                f"{MEANING}{_advice(result, key)}"
            )


def _advice(result: StudyResult, key: str) -> str:
    """How many keep to a constraint by such a peak alone, and which figure to ask for in its place."""
    text, limit = "", result.study.file.constraint.get(key)
    if limit is not None and limit.max is not None:
        kept = [r.outcome.figures for r in result.keeping(key)]
        if count := sum(at_border(key, figures) for figures in kept):
            text = f"; {len(kept)} designs meet this constraint, {count} of them with such a value"
    better = f"{ON_HALF_SEAT}_mises_MPa"
    if key == f"{ON_ELLIPSE}_mises_MPa" and _used(result, key) and not _used(result, better):
        text += f"; use {better} instead, on a seat half as wide as the ring"
    return text


def _used(result: StudyResult, key: str) -> str:
    """Whether a figure is an objective or a constraint of the study; "" for neither."""
    file = result.study.file
    roles = (("an objective", [*file.objective]), ("a constraint", [*file.constraint]))
    played = joined((role for role, keys in roles if key in keys), "and")
    return f"{played} of this study" if played else ""


def unsettled(result: StudyResult) -> Iterable[str]:
    """A line for each objective of a search whose best still moved in the last LATE_SHARE of its designs."""
    if result.study.file.run.method != "optimize":
        return
    last = (1 - LATE_SHARE) * len(result.rows)
    for i, key in enumerate(result.study.file.objective):
        values = [(r.slot, result.costs(r)[i]) for r in result.feasible]
        early = min((value for slot, value in values if slot < last), default=inf)
        best = min((value for _, value in values), default=inf)
        gain = (early - best) / max(abs(best), ABOVE_ZERO) if early < inf else inf
        if best < inf and gain > LEAST_MOVE:
            moved = "was first found" if gain == inf else f"still improved by {percent(gain)}"
            yield (
                f"the search has not converged: the best “{entry(key).name}” {moved} in the last quarter of "
                f"the {len(result.rows)} designs; more evaluations (run.evaluations) may find a better one"
            )


def unmoved(result: StudyResult) -> Iterable[str]:
    """A line for each objective that is the same in all designs: there is no best one."""
    for key in result.study.file.objective:
        values = {r.outcome.figures[key] for r in result.built if key in r.outcome.figures}
        if len(values) == 1 and len(result.built) > 1:
            yield (
                f"“{entry(key).name}” is the same in all {len(result.built)} designs: it does not depend on "
                "the varied keys, so no design is the best"
            )


def preloaded(result: StudyResult) -> Iterable[str]:
    """A line where teeth press on both flanks without torque in some designs: no gear runs like that."""
    forces = [r.outcome.figures.get(PRELOAD, 0.0) for r in result.built]
    if count := sum(force > 0 for force in forces):
        best = [
            str(r.slot)
            for r in result.best(LISTED_DESIGNS)
            if r.outcome.figures.get(PRELOAD, 0.0) > 0
        ]
        among = f"; among the best: {', '.join(best)}" if best else ""
        yield (
            f"in {count} of {len(forces)} designs teeth press on both flanks without torque ({PRELOAD} in "
            f"study.csv; a constraint on it excludes them){among}"
        )


def _whole_gear(result: StudyResult) -> Iterable[str]:
    """What its figures leave out, and which designs do not run."""
    if not any(PRELOAD in r.outcome.figures for r in result.built):
        return
    varied = result.study.keys
    assumed = gear_assumptions(result.study.design)
    keys = ", ".join(a.key for a in assumed if a.key not in varied)
    yield (
        "Whole gear: wave generator locked, no friction; T1 and T2 are "
        f"{T1_SHARE:g} and {T2_SHARE:g} of rated torque; an odd "
        "number of balls is computed as the next even one; run.verify does not solve it again."
        + (f" Not stated, therefore assumed in proportion: {keys}." if keys else "")
    )
    yield from map(sentence, preloaded(result))


def _mass(design: Design) -> str:
    """Which density weighs the parts, and who says so."""
    densities = []
    for part in PART_NAMES:
        material = design.part(part).material
        source = (
            "as stated" if material.density_stated else "of steel, because the file states none"
        )
        densities.append(f"{material.density_kg_per_m3:g} kg/m³ ({source})")
    if densities[0] == densities[1]:
        return f"Mass at {densities[0]}."
    return f"Mass of the flexspline at {densities[0]}, of the shaft at {densities[1]}."


def _holes(result: StudyResult) -> Iterable[str]:
    """What is known of K_b and K_e of parts with holes or a keyway."""
    design = result.study.design
    if design.part("flexspline").bolts is not None:
        yield (
            "K_b of every design with bolt holes lies between two parts: one with the ring of the holes cut "
            "out, one without holes. The number of holes does not matter. Stresses are computed without "
            "holes."
        )
        yield from map(sentence, wide_bounds(result))
    if pierced(design):
        yield from _shaft_holes(result)
    if keys := unfollowed(result.study):
        yield f"The fast model ignores {keys}; the mass includes them, and run.verify solves them."


def wide_bounds(result: StudyResult) -> Iterable[str]:
    """A line where bolt holes leave K_b of some designs less certain than `solver.tolerance_pct` asks."""
    key, low, high = stiffness_keys("K_b")
    tolerance = result.study.design.solver.tolerance
    figures = [r.outcome.figures for r in result.built if low in r.outcome.figures]
    halves = [(f[high] - f[low]) / (2 * f[key]) for f in figures]
    if count := sum(half > tolerance for half in halves):
        yield (
            f"in {count} of {len(halves)} designs bolt holes leave bounds of K_b wider than "
            f"± {percent(tolerance)}, up to ± {percent(max(halves))}: K_b is the midpoint; its error may "
            "be as large as the half-width; run.verify solves the best designs with the solid model"
        )


def _shaft_holes(result: StudyResult) -> Iterable[str]:
    """How K_e was corrected, and what that does to its bounds; nothing where no design has it."""
    if result.no_holes_effect:
        yield (
            "K_e is computed for the shaft without its holes or keyway: the solid solve for their effect "
            f"failed ({result.no_holes_effect})."
        )
    key = "K_e_holes_factor"
    factors = [r.outcome.figures[key] for r in result.built if key in r.outcome.figures]
    if not factors:
        return
    moved = drifts(result.study.keys)
    share = f" and by {100 * HOLE_EFFECT_DRIFT:g} % of the correction" if moved else ""
    ends = list(dict.fromkeys(percent_change(f - 1) for f in (max(factors), min(factors))))
    yield (
        f"Holes and keyway change K_e by {' to '.join(ends)}. Their effect is taken as the same share of the "
        "compliance of flange and keyway as in the start design (one solid solve). The bounds of K_e are "
        f"widened by the uncertainty of both solves{share}; they are estimates."
    )
