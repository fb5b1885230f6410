"""flexspline on one load case of the rim, which no command solves alone: what `flexspline stiffness` calls.

python benchmarks/rim_alone.py DESIGN.toml lobes | lobes_unsupported | ellipse
"""

from __future__ import annotations

import json
import sys
from typing import Any

import flexspline
from flexspline.geometry.design import Design


def main() -> None:
    path, load = sys.argv[1:]
    design = flexspline.load_design(path)
    print(json.dumps(peak(design) if load == "ellipse" else stiffness(design, load)))


def stiffness(design: Design, load: Any) -> dict[str, Any]:
    found = flexspline.stiffness(design, "flexspline", load)
    low, high = found.bounds_Nm_per_rad
    K, finest = found.K_Nm_per_rad, found.levels[-1]
    return {
        "K": K, "bound_pct": 50 * (high - low) / K, "unknowns": finest.dofs,
        "elements": finest.elements, "model": found.model,
        "bounds_kind": "guaranteed" if found.guaranteed else "estimated",
    }  # fmt: skip


def peak(design: Design) -> dict[str, Any]:
    from flexspline.pipeline.analysis import analysis_context
    from flexspline.pipeline.ellipse_peak import ellipse_peak

    found = ellipse_peak(analysis_context(design).part("flexspline"))
    return {"peak_MPa": found.mises_MPa, "at_mm": found.at_mm}


if __name__ == "__main__":
    main()
