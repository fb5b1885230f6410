"""How assembly and solution grow with the unknowns, past a million: the six-hole cup made finer.

`python benchmarks/scaling.py` measures it into results.json; with MESH.npz it times that one mesh, in a
process of its own.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from cases import CASES
from measure import run

from flexspline.fea.types import TetMesh

FAR_MM = {30.0: (0.3,), 90.0: (2.4, 1.2, 0.8, 0.55, 0.4, 0.36), 360.0: (2.4, 1.2, 0.8, 0.7, 0.6)}
"""Edge lengths for the wedge, the quarter and the whole cup."""
RESULTS = Path(__file__).with_name("results.json")
NEAR_SHARE = 0.4
MEMORY = 8 * 2**30
"""Address space of a run [bytes]: one that would need more fails."""


def growth() -> list[dict[str, Any]]:
    """Unknowns, seconds and peak memory of the quarter and the whole cup at each edge length."""
    found = []
    for sector, far in ((sector, far) for sector, lengths in FAR_MM.items() for far in lengths):
        wedge = wedge_mesh(far)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            np.savez(
                folder / "mesh.npz", nodes=wedge.nodes, cells=wedge.cells, facets=wedge.facets,
                facet_patch=wedge.facet_patch, patches=np.array(wedge.patches), sector=sector,
                sector_deg=wedge.sector_deg,
            )  # fmt: skip
            command = [sys.executable, str(Path(__file__).resolve()), "mesh.npz"]
            one = run(command, folder, None, MEMORY)
        found.append({"far_mm": far, "sector_deg": sector} | one)
        print(found[-1], flush=True)
    return sorted(found, key=lambda r: r.get("unknowns", 0))


def wedge_mesh(far: float) -> TetMesh:
    from flexspline.fea.solid.defaults import first_spec
    from flexspline.fea.solid.sizing import Grading
    from flexspline.fea.solid.swept import swept_mesh
    from flexspline.geometry.load import design_from

    design = design_from(tomllib.loads(CASES[1].design_text()))
    spec = replace(
        first_spec(design.part("flexspline")), grading=Grading(NEAR_SHARE * far, far, 1.0)
    )
    mesh = swept_mesh(design.part("flexspline"), 30.0, spec)
    assert mesh is not None
    return mesh


def one(path: str) -> dict[str, Any]:
    """Assembly and solution of one mesh in this process."""
    from flexspline.fea.solid.load_cases import torsion
    from flexspline.fea.solid.model import Model
    from flexspline.fea.solid.unfold import unfolded
    from flexspline.fea.types import Elastic

    with np.load(path) as m:
        names = tuple(str(p) for p in m["patches"])
        arrays = (m[k] for k in ("nodes", "cells", "facets", "facet_patch"))
        wedge = TetMesh(*arrays, names, float(m["sector_deg"]))
        mesh = unfolded(wedge, float(m["sector"]))
    began = time.perf_counter()
    model = Model.of(mesh, Elastic(206e3, 0.3))
    assembled = time.perf_counter()
    solved = torsion(model, "mesh")
    return {
        "unknowns": solved.dofs, "elements": len(mesh.cells),
        "assembly_s": round(assembled - began, 3),
        "solve_s": round(time.perf_counter() - assembled, 3), "K": solved.K_energy, "way": solved.way,
    }  # fmt: skip


def measure() -> None:
    """Replace the growth in results.json, with the load of the machine at its start."""
    load = [round(x, 2) for x in os.getloadavg()]
    found = growth()
    known = json.loads(RESULTS.read_text(encoding="utf-8"))
    known |= {"scaling": found, "load_at_scaling": load}
    RESULTS.write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print("\n" + json.dumps(one(sys.argv[1])))
    else:
        measure()
