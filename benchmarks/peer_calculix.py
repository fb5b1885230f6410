"""K_b by CalculiX: C3D10 on Netgen's curved second-order mesh of the whole cup's STEP file."""

from __future__ import annotations

import json
import os
import subprocess
import time

BEGAN = time.perf_counter()

import numpy as np  # noqa: E402
from peer_geometry import Job, job, meshed  # noqa: E402

ANGLE = 1e-3
CORNER_PAIRS = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
"""C3D10: corners between which nodes 5 to 10 lie."""


def main() -> None:
    j = job()
    imported = time.perf_counter()
    nodes, cells, sets = second_order(meshed(j))
    made = time.perf_counter()
    radius = np.hypot(nodes[:, 0], nodes[:, 1])
    with open("deck.inp", "w", encoding="utf-8") as out:
        out.write(deck(j, nodes, cells, sets, radius))
    written = time.perf_counter()
    threads = str(os.cpu_count())
    subprocess.run(["ccx", "-i", "deck"], check=True, env=os.environ | {"OMP_NUM_THREADS": threads})
    torque = 0.0
    with open("deck.dat", encoding="utf-8") as found:
        for line in found:
            words = line.split()
            if len(words) >= 4 and words[0].isdigit():
                torque += radius[int(words[0]) - 1] * float(words[2])
    print()
    print(json.dumps({
        "K": torque / ANGLE / 1000, "unknowns": 3 * len(nodes), "elements": len(cells),
        "stages_s": {
            "import": round(imported - BEGAN, 2), "mesh": round(made - imported, 2),
            "deck": round(written - made, 2), "solve": round(time.perf_counter() - written, 2),
        },
    }))  # fmt: skip


def second_order(mesh):
    """Nodes (n, 3), C3D10 cells (m, 10), and the nodes of each named boundary."""
    mesh.SecondOrder()
    nodes = np.array(mesh.Coordinates())
    raw = mesh.Elements3D().NumPy()
    cells = raw["nodes"][:, :10].astype(np.int64) - 1
    corners = cells[:, :4]
    a, b, c = (nodes[corners[:, i]] - nodes[corners[:, 0]] for i in (1, 2, 3))
    flipped = np.einsum("ij,ij->i", np.cross(a, b), c) < 0
    corners = np.where(flipped[:, None], corners[:, [0, 2, 1, 3]], corners)
    # Netgen orders the middle nodes its own way: find each by the straight edge that it is nearest to
    middles = nodes[cells[:, 4:]]
    ordered = [corners]
    for p, q in CORNER_PAIRS:
        wanted = (nodes[corners[:, p]] + nodes[corners[:, q]]) / 2
        nearest = np.linalg.norm(middles - wanted[:, None], axis=2).argmin(axis=1)
        ordered.append(cells[np.arange(len(cells)), 4 + nearest][:, None])
    cells = np.hstack(ordered)
    assert all(len(set(row)) == 10 for row in cells[:: max(1, len(cells) // 1000)].tolist())
    surface = mesh.Elements2D().NumPy()
    faces, index = surface["nodes"][:, :6].astype(np.int64) - 1, surface["index"]
    sets = {}
    for name in ("mount", "mesh"):
        mine = [i for i in np.unique(index) if mesh.GetBCName(int(i) - 1) == name]
        sets[name] = np.unique(faces[np.isin(index, mine)])
    return nodes, cells, sets


def deck(j: Job, nodes, cells, sets, radius) -> str:
    """Mount held, mesh turned by ANGLE in cylindrical axes, reactions of mesh printed."""
    lines = ["*NODE"]
    lines += [f"{i},{x:.12g},{y:.12g},{z:.12g}" for i, (x, y, z) in enumerate(nodes, 1)]
    lines.append("*ELEMENT, TYPE=C3D10, ELSET=PART")
    lines += [f"{i}," + ",".join(map(str, c)) for i, c in enumerate((cells + 1).tolist(), 1)]
    for name, members in sets.items():
        lines.append(f"*NSET, NSET={name.upper()}")
        lines += [f"{i + 1}," for i in members]
    lines += ["*TRANSFORM, NSET=MESH, TYPE=C", "0.,0.,0.,0.,0.,1.", "*MATERIAL, NAME=M"]
    lines += ["*ELASTIC", f"{j.patches['E']},{j.patches['nu']}"]
    lines += ["*SOLID SECTION, ELSET=PART, MATERIAL=M", "*STEP", "*STATIC", "*BOUNDARY"]
    lines += ["MOUNT,1,3", "MESH,1,1", "MESH,3,3"]
    lines += [f"{i + 1},2,2,{ANGLE * radius[i]:.12g}" for i in sets["mesh"]]
    lines += ["*NODE PRINT, NSET=MESH, GLOBAL=NO", "RF", "*END STEP"]
    return "\n".join(lines) + "\n"


main()
