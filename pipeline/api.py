"""The Python functions for designs: the commands as functions (for measured files: `measured.py`).

Results are kept in the same cache as the commands'. Nothing is printed. What a function needs is imported
in it: to name one loads nothing heavy, and a backlash of given stiffnesses loads no solver.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

from flexspline.geometry.errors import DesignError
from flexspline.geometry.input_file import file_name
from flexspline.geometry.part_name import PART_NAMES, PartName
from flexspline.pipeline.given import require_design, warn_of_first_face
from flexspline.pipeline.rim_case import RIM_CASES, RimCase

if TYPE_CHECKING:
    from flexspline.fea.types import SolidField, Stiffness
    from flexspline.geometry.design import Design
    from flexspline.pipeline.backlash import Backlash
    from flexspline.pipeline.gear.gear_curve import GearCurve
    from flexspline.pipeline.stress_limits import StressCase
    from flexspline.pipeline.study.result import StudyResult
    from flexspline.pipeline.study.slope import Slope


def stiffness(
    design: Design,
    part: PartName = "flexspline",
    case: Literal["uniform"] | RimCase = "uniform",
) -> Stiffness:
    """Return the torsional stiffness of a part with its error bounds [N·m/rad].

    Parameters
    ----------
    case : how the torque enters the flexspline: "uniform" (round the toothed ring), "lobes" (at the two
        tooth engagements, the seat held round by the wave generator), "lobes_unsupported" (the same, the
        seat free), "lobes_contact" (the seat rests on the wave generator and may lift off). The shaft has
        "uniform" only.

    Returns
    -------
    Stiffness : `K_Nm_per_rad`, `bounds_Nm_per_rad`, and `guaranteed`: whether the bounds are theorems.

    Raises
    ------
    DesignError : no such part or case, or the design asks for a model that the part does not allow.
    ComputationError : no mesh or no solution; lift-off without bolt holes asked of the solid model.
    NestingError : two models contradict each other; no figure is to be trusted.

    Examples
    --------
    The XB1-40 without its bolt holes lies between 31 330 and 31 337 N·m/rad (docs/validation.md):

    >>> from flexspline import load_design, stiffness
    >>> design = load_design("examples/xb1-40.toml").changed({"flexspline.bolt_count": 0})
    >>> K_b = stiffness(design, "flexspline")
    >>> lower, upper = K_b.bounds_Nm_per_rad
    >>> K_b.guaranteed and lower < 31337 and upper > 31330
    True
    """
    from flexspline.pipeline.analysis import analysis_context
    from flexspline.pipeline.load_cases import rim_stiffness
    from flexspline.pipeline.part_stiffness import part_stiffness

    require_design(design)
    if not isinstance(part, str) or part not in PART_NAMES:
        raise DesignError("part", part, 'must be "flexspline" or "shaft"')
    if case not in ("uniform", *RIM_CASES):
        raise DesignError("case", case, f"must be one of uniform, {', '.join(RIM_CASES)}")
    model = analysis_context(design).part(part)
    if case == "uniform":
        if part == "shaft":
            warn_of_first_face(design)
        return part_stiffness(model)
    if part == "shaft":
        raise DesignError("case", case, 'applies to the flexspline; the shaft has "uniform" only')
    return rim_stiffness(model, case)


def stress(design: Design, case: StressCase = "wave_generator") -> SolidField:
    """Displacement and von Mises stress of a load case on tetrahedra of a sector of the part.

    `peak` is the largest stress outside of what it excludes: at sharp edges stress only grows with the mesh.

    Parameters
    ----------
    case : "wave_generator" (the ellipse, no torque), "flexspline_torque" or "shaft_torque" (at T_L).

    Raises
    ------
    DesignError : no such case.
    ComputationError : no mesh or no solution.
    NestingError : two models contradict each other; no figure is to be trusted.

    Examples
    --------
    Twice the torque doubles the stress:

    >>> from flexspline import load_design, stress
    >>> design = load_design("examples/xb1-40.toml")
    >>> twice = design.changed({"load.torque_Nm": 2 * design.load.torque_Nm})
    >>> once, double = (stress(d, "shaft_torque").peak.mises_MPa for d in (design, twice))
    >>> round(double / once, 9)
    2.0
    """
    from flexspline.pipeline.analysis import analysis_context
    from flexspline.pipeline.ellipse_peak import ellipse_field
    from flexspline.pipeline.stress_limits import STRESS_CASES
    from flexspline.pipeline.torque_stress import torque_field

    require_design(design)
    context = analysis_context(design)
    if case == "wave_generator":
        return ellipse_field(context.part("flexspline"))
    if case not in STRESS_CASES:
        raise DesignError("case", case, f"must be one of {', '.join(STRESS_CASES)}")
    return torque_field(context.part("shaft" if case == "shaft_torque" else "flexspline"))


def backlash(design: Design, K_b: float | None = None, K_e: float | None = None) -> Backlash:
    """Return the four-term sum in arcsec; K_b, K_e [N·m/rad] of flexspline and shaft, by FE where not given.

    Raises
    ------
    DesignError
    StiffnessValueError : a stiffness that is not positive and finite.
    BearingPlayDomainError : bearing play beyond the largest that the involute model allows.
    ComputationError : a stiffness that is needed was not found.
    NestingError : two models contradict each other; no figure is to be trusted.

    Examples
    --------
    The shaft's wind-up is 2T/K_e, as in table 2 of the article (0.5 N·m on 1.8e4 N·m/rad, 11.5″):

    >>> from flexspline import backlash, load_design
    >>> total = backlash(load_design("examples/xb1-40.toml"), K_b=3.1e4, K_e=1.8e4)
    >>> round(total.shaft_arcsec, 1)
    11.5
    >>> total.total_arcsec > total.shaft_arcsec + total.flexspline_arcsec
    True
    """
    from flexspline.pipeline.backlash import backlash as sum_of_terms
    from flexspline.pipeline.stiffness_pair import given_pair, stiffness_pair

    require_design(design)
    used = given_pair(K_b, K_e)
    if used is None:
        from flexspline.pipeline.analysis import analysis_context

        if K_e is None:
            warn_of_first_face(design)
        used = stiffness_pair(analysis_context(design), K_b, K_e)
    return sum_of_terms(design, used.K_b_Nm_per_rad, used.K_e_Nm_per_rad)


def gear(design: Design) -> GearCurve:
    """Solve the whole gear with its wave generator locked: torque-angle curve, K1, K2, K3, lost motion.

    Returns
    -------
    GearCurve : `K1_Nm_per_rad` … `lost_motion_arcsec`, the loop `torque_Nm`, `angle_arcsec`, and `assumed`:
        what the design does not state.

    Raises
    ------
    DesignError
    ComputationError : no mesh or no solution, or no equilibrium at a torque.
    NestingError : two models contradict each other; no figure is to be trusted.

    Examples
    --------
    Teeth that come into contact one after another make it stiffen:

    >>> from flexspline import gear, load_design
    >>> curve = gear(load_design("examples/xb1-40.toml"))
    >>> curve.K1_Nm_per_rad < curve.K2_Nm_per_rad < curve.K3_Nm_per_rad
    True
    """
    from flexspline.pipeline.analysis import analysis_context
    from flexspline.pipeline.gear.gear_curve import gear_curve

    require_design(design)
    warn_of_first_face(design)
    return gear_curve(analysis_context(design))


def sensitivity(design: Design) -> tuple[Slope, ...]:
    """Return dK/dp of every length of both parts, the strongest first within a part; holes are left out.

    Raises
    ------
    DesignError, ComputationError

    Examples
    --------
    A thicker wall makes a flexspline stiffer:

    >>> from flexspline import load_design, sensitivity
    >>> slopes = {s.key: s for s in sensitivity(load_design("examples/xb1-40.toml"))}
    >>> slopes["flexspline.wall_thickness_mm"].elasticity > 0
    True
    """
    from flexspline.pipeline.study.sensitivity import sensitivities

    require_design(design)
    warn_of_first_face(design)
    return sensitivities(design, lambda line: None)


def study(path: Path | str, out: Path | str | None = None) -> StudyResult:
    """Evaluate a study file; `out` (default NAME.out beside it) keeps its designs, and a second call resumes.

    Raises
    ------
    DesignError : the study file or its design is wrong.
    ComputationError : its storage or its cluster went away. Designs that fail are rows.
    NestingError : two models of the shaft contradict each other before the first design.

    Examples
    --------
    >>> import tempfile
    >>> from flexspline import study
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     result = study("examples/studies/grid.toml", out=folder)
    >>> len(result.rows)
    9
    """
    from flexspline.pipeline.default_folder import default_folder
    from flexspline.pipeline.study.load import load_study
    from flexspline.pipeline.study.run import trial_store_of, whole_study

    path = file_name(path, "study")
    loaded = load_study(path)
    folder = file_name(out, "out") if out is not None else default_folder(path)
    store = trial_store_of(loaded, folder)
    return whole_study(loaded, store)
