"""What the figures are: bounds that are theorems, harmonics on the finest meridian, programs that agree."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cases import Case
from programs import Setting, ours, peers

FINE = (Setting(3, 3.0, 0.04, 0.6), Setting(3, 3.0, 0.02, 0.6))
"""Two NGSolve wedges: the error of K is proportional to the edge length at singular circles, so the
second less the first's difference is the limit."""
FINE_QUARTER = (Setting(3, 1.0, 0.15, 0.6), Setting(3, 1.0, 0.075, 0.6))
BOUNDS, PEAK_TOLERANCE = 2e-5, 2e-4
LOBE_BOUNDS = 1e-4
"""Of the estimated bounds' distance."""
OURS_PCT, OURS_LOBES_PCT = 0.03, 0.1
"""The lobes' bounds with holes are those of two bodies of revolution, which are no nearer to each other."""


def references(load: str, python: str, steps: Path) -> dict[str, dict[str, Any]]:
    """The figure of both cups under a load, how it was found, and how far the programs are apart."""
    of = {"uniform": _of_uniform, "ellipse": _of_peaks}.get(load, _of_lobes)
    return of(Case(0, load), Case(6, load), python, steps)


def _of_uniform(free: Case, six: Case, python: str, steps: Path) -> dict[str, dict[str, Any]]:
    """Each program's own limit; NGSolve's is cleared of what it misses on the known case."""
    known, own = known_stiffness(free), ours(six, OURS_PCT)
    (_, at_free), (_, at_six) = (limit(c, python, steps) for c in (free, six))
    cleared = at_six * known["K"] / at_free
    return {
        free.name: known | {"ngsolve": at_free},
        six.name: {
            "K": (cleared + own["K"]) / 2, "ngsolve": at_six, **_ours_beside(cleared, own),
            "how": "mean of NGSolve's and flexspline's finest",
        },
    }  # fmt: skip


def _of_lobes(free: Case, six: Case, python: str, steps: Path) -> dict[str, dict[str, Any]]:
    """With holes by NGSolve: its finest mesh, cleared of what as fine a one misses on the known case.

    That ratio scatters less than the limits' from mesh to mesh: by 0.01 % at most on three pairs of meshes.
    """
    known, own = known_stiffness(free), ours(six, OURS_LOBES_PCT)
    (fine_free, at_free), (fine_six, at_six) = (limit(c, python, steps) for c in (free, six))
    K = known["K"] * fine_six / fine_free
    return {
        free.name: known | {"ngsolve": fine_free, "ngsolve_limit": at_free},
        six.name: {
            "K": K, "ngsolve": fine_six, "ngsolve_limit": at_six, **_ours_beside(K, own),
            "how": "NGSolve's finest, less what it misses without holes",
        },
    }  # fmt: skip


def _ours_beside(K: float, own: dict[str, Any]) -> dict[str, float]:
    return {
        "flexspline": own["K"], "flexspline_bound_pct": own["bound_pct"],
        "apart_pct": 100 * abs(K / own["K"] - 1),
    }  # fmt: skip


def _of_peaks(free: Case, six: Case, python: str, steps: Path) -> dict[str, dict[str, Any]]:
    """The bodies that enclose the cup with holes have one peak, so it is that cup's (docs/theory.md)."""
    from flexspline.geometry.nested import nested_bodies

    bodies = nested_bodies(six.design().part("flexspline"))
    whole, cut = (_peak(six, body) for body in (bodies.whole, bodies.cut))
    theirs = {c.name: _peer(c, FINE_QUARTER[1], python, steps) for c in (free, six)}
    return {
        free.name: {
            "peak_MPa": whole, "ngsolve": theirs[free.name], "how": "harmonics on the finest meridian",
        },
        six.name: {
            "peak_MPa": (whole + cut) / 2, "ngsolve": theirs[six.name],
            "apart_pct": 100 * abs(whole / cut - 1),
            "how": "mean of the two bodies of revolution, on the finest meridians",
        },
    }  # fmt: skip


def limit(case: Case, python: str, steps: Path) -> tuple[float, float]:
    """NGSolve's K on a sector's finer mesh, and extrapolated to zero edge length at the singular circles."""
    settings = FINE if case.load == "uniform" else FINE_QUARTER
    coarse, fine = (_peer(case, s, python, steps) for s in settings)
    ratio = settings[1].edge / settings[0].edge
    return fine, fine - (coarse - fine) * ratio / (1 - ratio)


def _peer(case: Case, setting: Setting, python: str, steps: Path) -> float:
    return peers(python, case)[0].run(case, setting, steps)[case.figure]


def known_stiffness(case: Case) -> dict[str, Any]:
    """K of the hole-free cup [N·m/rad] by its bounds: theorems, or at the lobes estimates."""
    from flexspline.fea.axisymmetric.lobes import lobe_stiffnesses
    from flexspline.fea.axisymmetric.torsion import torsional_stiffness
    from flexspline.fea.types import Elastic

    design = case.design()
    material = Elastic.of(design.material.flexspline)
    outline = design.part("flexspline").meridian
    if case.load == "uniform":
        found = torsional_stiffness(outline, material, "mesh", BOUNDS)
        how = "axisymmetric bounds that are theorems"
    else:
        *_, found = lobe_stiffnesses(outline, material, case.load == "lobes", LOBE_BOUNDS)
        how = "harmonics on the finest meridian"
    low, high = found.bounds_Nm_per_rad
    return {"K": (low + high) / 2, "bounds": [low, high], "how": how}


def _peak(case: Case, body: Any) -> float:
    """The ellipse's peak of a body of revolution [MPa]."""
    from flexspline.fea.axisymmetric.stress import ellipse_stress
    from flexspline.fea.types import Elastic

    design = case.design()
    material = Elastic.of(design.material.flexspline)
    found = ellipse_stress(body.meridian, material, design.w0_mm, body.exclusion_mm, PEAK_TOLERANCE)
    return found.peak.mises_MPa
