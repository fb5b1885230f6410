"""Writes xb1-40-specimens.csv: made-up stiffnesses, so that `flexspline diagnose` has something to read.

Nobody measured this. Eight flexsplines of examples/xb1-40.toml with drawings of their own; the stiffness
is FE's, bolt holes included, with every wall 0.14 mm thinner than drawn, and 1 % of noise.

    python3 examples/measured/make_specimens.py
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from flexspline.geometry.load import design_from, load_design
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress

HERE = Path(__file__).parent
DRAWN = (
    (30, 0.40, 0.60), (24, 0.45, 0.80), (36, 0.50, 0.60), (33, 0.40, 0.90),
    (27, 0.52, 0.50), (39, 0.45, 0.70), (30, 0.48, 0.75), (34, 0.42, 0.55),
)  # fmt: skip
"""Length, wall, diaphragm [mm]."""
THINNER_MM, NOISE, SEED = 0.14, 0.01, 40
HEAD = """\
# MADE UP, not measured: written by make_specimens.py, which says what is hidden in it
specimen,part,stiffness_Nm_per_rad,stiffness_std_Nm_per_rad,flexspline.length_mm,\
flexspline.wall_thickness_mm,flexspline.diaphragm_thickness_mm
"""


def lines() -> list[str]:
    """Rows of the file: FE of each part as it really is, and noise."""
    tables = load_design(HERE.parent / "xb1-40.toml").tables
    rng = np.random.default_rng(SEED)
    found = []
    with TemporaryDirectory() as folder:
        for i, (length, wall, diaphragm) in enumerate(DRAWN):
            rim = tables["flexspline"]
            rim["length_mm"], rim["diaphragm_thickness_mm"] = float(length), diaphragm
            rim["wall_thickness_mm"] = round(wall - THINNER_MM, 3)
            context = AnalysisContext(design_from(tables), Cache(Path(folder)), Progress())
            K = context.part("flexspline").stiffness().K_Nm_per_rad * (
                1 + NOISE * rng.standard_normal()
            )
            found.append(
                f"S{i + 1},flexspline,{round(K, -1):.0f},{round(NOISE * K, -1):.0f},{length},{wall:.2f},"
                f"{diaphragm:.2f}"
            )
    return found


if __name__ == "__main__":
    text = HEAD + "\n".join(lines()) + "\n"
    (HERE / "xb1-40-specimens.csv").write_text(text, encoding="utf-8")
