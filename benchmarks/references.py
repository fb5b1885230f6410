"""What K_b is: bounds that are theorems without holes, two programs that agree with them."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from cases import CASES, Case
from programs import Peer, Setting, ours

FINE = (Setting(3, 3.0, 0.04, 0.6), Setting(3, 3.0, 0.02, 0.6))
"""Two NGSolve wedges: the error of K is proportional to the edge length at singular circles, so the
second less the first's difference is the limit."""
BOUNDS = 2e-5
OURS_PCT = 0.03


def references(peer: Peer, steps: Path) -> dict[str, dict[str, Any]]:
    """K [N·m/rad] of each case, how it was found, and how far the programs are apart."""
    free, six = CASES
    low, high = guaranteed(free)
    found = {
        free.name: {
            "K": (low + high) / 2, "bounds": [low, high], "ngsolve": limit(free, peer, steps),
            "how": "axisymmetric bounds that are theorems",
        }
    }  # fmt: skip
    theirs, own = limit(six, peer, steps), ours(six, OURS_PCT)
    # each program's own limit; NGSolve's is cleared of what it misses on the known case
    known = found[free.name]
    theirs_cleared = theirs * known["K"] / known["ngsolve"]
    found[six.name] = {
        "K": (theirs_cleared + own["K"]) / 2, "ngsolve": theirs, "flexspline": own["K"],
        "flexspline_bound_pct": own["bound_pct"],
        "apart_pct": 100 * abs(theirs_cleared / own["K"] - 1),
        "how": "mean of NGSolve's and flexspline's finest",
    }  # fmt: skip
    return found


def limit(case: Case, peer: Peer, steps: Path) -> float:
    """NGSolve's K on the wedge extrapolated to zero edge length at the singular circles."""
    coarse, fine = (peer.run(case, s, steps)["K"] for s in FINE)
    ratio = FINE[1].edge / FINE[0].edge
    return fine - (coarse - fine) * ratio / (1 - ratio)


def guaranteed(case: Case) -> tuple[float, float]:
    """Lower and upper bound of the hole-free cup's K_b [N·m/rad]."""
    from flexspline.fea.axisymmetric.torsion import torsional_stiffness
    from flexspline.fea.types import Elastic
    from flexspline.geometry.load import design_from

    design = design_from(tomllib.loads(case.design_text()))
    material = Elastic.of(design.material.flexspline)
    found = torsional_stiffness(design.part("flexspline").meridian, material, "mesh", BOUNDS)
    return found.lower_Nm_per_rad, found.upper_Nm_per_rad
