"""The complete analysis of a design: stiffnesses, stresses, backlash. Each command uses a part of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from flexspline.fea.types import SolidField
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError, DesignError
from flexspline.geometry.sanity import warnings
from flexspline.pipeline.attempts import Attempts
from flexspline.pipeline.backlash import Backlash, backlash
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.ellipse_peak import ellipse_field, full_seat_peak
from flexspline.pipeline.figure_tasks import FigureTasks
from flexspline.pipeline.gear.gear_curve import GearCurve, gear_curve
from flexspline.pipeline.linear_limit import LinearLimit, linear_limit
from flexspline.pipeline.parts import AnalysisContext, PartModel
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.stiffnesses import Stiffnesses, in_order
from flexspline.pipeline.storage import cache_folder
from flexspline.pipeline.stress_limits import PEAK_OF, STRESS_CASES
from flexspline.pipeline.torque_stress import torque_field
from flexspline.pipeline.two_threads import beside


def analysis_context(
    design: Design,
    say: Callable[[str], None] = lambda line: None,
    progress: Progress | None = None,
) -> AnalysisContext:
    """A design with the user's cache of solved parts; `say` is told the cache's faults, and the stages too
    where there is no `progress` yet."""
    cache = Cache(cache_folder(), say)
    return AnalysisContext(design, cache, progress or Progress(say))


@dataclass(frozen=True)
class RunResult:
    """Everything that `flexspline run` found.

    `fields` has "flexspline_torque", "shaft_torque" and "wave_generator", but for those that are
    `stiffnesses.missing`. `gear` is the whole gear's curve, None where it is missing likewise. `warnings` are
    the design's own.
    """

    design: Design
    warnings: tuple[str, ...]
    stiffnesses: Stiffnesses
    fields: Mapping[str, SolidField]
    backlash: Backlash
    linear_limit: LinearLimit
    stage_seconds: Mapping[str, float]
    gear: GearCurve | None = None


def stiffnesses(
    context: AnalysisContext,
    flexspline: bool = True,
    shaft: bool = True,
    rim: bool = True,
    solved: Callable[[PartModel], None] = lambda part: None,
    begun: Callable[[], None] = lambda: None,
) -> Stiffnesses:
    """Solve all figures of `flexspline stiffness`, for the parts that are asked for.

    What fails is absent, with its reason in `missing`; the rest is there. `solved` is told each part
    after its K, by one of two threads. `begun` is called before the solves, and after this process has been
    copied where it may be (`second_process`).

    Without `rim` the lobes and the wave generator are left out: the backlash sum needs them only
    where `solver.load_case` says so.

    Raises
    ------
    DesignError
    ComputationError : the plain ring of drawn teeth failed.
    """
    rim_part, shaft_part = context.part("flexspline"), context.part("shaft")
    for wanted, part in ((flexspline, rim_part), (shaft, shaft_part)):
        if wanted:
            part.refuse_settings()
    tasks = FigureTasks(context, solved)
    if flexspline:
        tasks.add_part("K_b", rim_part)
    if shaft:
        tasks.add_part("K_e", shaft_part)
    if flexspline and rim:
        tasks.add_rim(rim_part)
    figures = tasks.figures(begun)
    wave_peak, tried, full_seat = figures.peaks.get("wave_generator_peak"), Attempts(), None
    if wave_peak is not None and not rim_part.axisymmetric and not wave_peak.stands_for:
        full_seat = tried.get("full_seat_peak", lambda: full_seat_peak(rim_part))
    return Stiffnesses(
        in_order(figures.K),
        wave_peak,
        figures.peaks.get("half_seat_peak"),
        context.ring if flexspline else None,
        {**figures.missing, **tried.missing},
        full_seat,
    )


def run(
    context: AnalysisContext,
    on_field: Callable[[str, SolidField], None] = lambda name, field: None,
    begun: Callable[[], None] = lambda: None,
) -> RunResult:
    """Solve all of `flexspline run`: stiffnesses, three stress fields, backlash sum, whole gear.

    A field or a curve that fails is absent, with its reason in `stiffnesses.missing`. `on_field` is
    given each of `RunResult.fields` as soon as it is there, by one of two threads. `begun`: as of
    `stiffnesses`.

    Raises
    ------
    DesignError
    NotFoundError : what the backlash sum needs failed; it carries what was found.
    """
    design = context.design
    tried, fields = Attempts(), dict[str, SolidField]()

    def solve(name: str, make: Callable[[], SolidField]) -> None:
        field = tried.get(name, make)
        if field is not None:
            fields[name] = field
            on_field(name, field)

    def under_torque(part: PartModel) -> None:
        solve(f"{part.name}_torque", lambda: torque_field(part))

    result = stiffnesses(context, solved=under_torque, begun=begun)
    result.require(design)
    total = backlash_of(design, result)
    tried_gear = Attempts()
    with beside(context.progress, [lambda: tried_gear.get("gear", lambda: _gear(context))]) as rest:
        solve("wave_generator", lambda: ellipse_field(context.part("flexspline")))
        (gear,) = rest()
    fields = {name: fields[name] for name in STRESS_CASES if name in fields}  # whoever was first
    result = replace(result, missing={**result.missing, **tried.missing, **tried_gear.missing})
    peaks = {PEAK_OF[name]: solved.peak for name, solved in fields.items()}
    limit = linear_limit(design, result.series_Nm_per_rad(design), peaks)
    seconds = dict(context.progress.seconds)
    return RunResult(design, warnings(design), result, fields, total, limit, seconds, gear)


def _gear(context: AnalysisContext) -> GearCurve:
    """A design that has no whole gear, as one whose play takes the stroke, has everything else.

    Raises
    ------
    ComputationError
    """
    try:
        return gear_curve(context)
    except DesignError as fault:
        raise ComputationError(str(fault)) from None


def backlash_of(design: Design, result: Stiffnesses) -> Backlash:
    """Return the four-term sum [arcsec] with these stiffnesses."""
    return backlash(design, result.in_sum(design).K_Nm_per_rad, result.K_e.K_Nm_per_rad)
