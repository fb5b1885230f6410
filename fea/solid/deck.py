"""The torsion case of a solid model as a CalculiX/Abaqus input deck, for an independent check.

The same nodes, quadratic tetrahedra (C3D10 numbers its ten nodes as `TetMesh` does), patches and
supports as `fea.solid.load_cases.torsion`. Node and element numbers in the deck count from 1.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from flexspline.fea.solid.assembly import NodeFrames
from flexspline.fea.types import NMM_PER_NM, Elastic, TetMesh
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START

DECK_ANGLE_RAD = 1e-3
"""[rad] Rotation Θ in the deck. The analysis is linear, so it only scales the printed reactions."""
PER_LINE = 12
"""Node numbers in a line of a set; the format allows 16."""


def torsion_deck(
    mesh: TetMesh, material: Elastic, driven: str, K_Nm_per_rad: float, title: str
) -> str:
    """Return a deck in which `mount` is held and `driven` turned rigidly about z by DECK_ANGLE_RAD.

    `K_Nm_per_rad` is our own figure on this mesh, whole part, quoted in the header for comparison.
    Units of the deck: mm, N, MPa.
    """
    radius = NodeFrames.cylindrical(mesh.nodes).radius
    held = mesh.nodes_on("mount")
    turned = np.setdiff1d(mesh.nodes_on(driven), held)
    planes = np.union1d(mesh.nodes_on(SYMMETRY_START), mesh.nodes_on(SYMMETRY_END))
    planes = np.setdiff1d(planes, np.union1d(held, turned))
    on_axis = radius[planes] == 0
    axis, planes = planes[on_axis], planes[~on_axis]
    local = np.concatenate([planes, turned])
    lines = [
        *_header(mesh, driven, K_Nm_per_rad, title),
        "*NODE, NSET=ALL",
        *(f"{i}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(mesh.nodes, 1)),
        "*ELEMENT, TYPE=C3D10, ELSET=PART",
        *(f"{i}, " + ", ".join(map(str, c)) for i, c in enumerate((mesh.cells + 1).tolist(), 1)),
        "** the named patches",
    ]
    for patch in filter(None, mesh.patches):
        lines += _node_set(patch.upper(), mesh.nodes_on(patch))
    lines.append("** nodes by what is prescribed there: no node is in two of these")
    for name, nodes in (
        ("HELD", held), ("TURNED", turned), ("ANTISYMMETRIC", planes), ("AXIS", axis),
        ("CYLINDRICAL", local),
    ):  # fmt: skip
        lines += _node_set(name, nodes)
    lines += [
        "** 1 radial, 2 tangential, 3 axial at these nodes",
        "*TRANSFORM, NSET=CYLINDRICAL, TYPE=C",
        "0., 0., 0., 0., 0., 1.",
        "*MATERIAL, NAME=ELASTIC",
        "*ELASTIC",
        f"{material.youngs_modulus_MPa:.12g}, {material.poissons_ratio:.12g}",
        "*SOLID SECTION, ELSET=PART, MATERIAL=ELASTIC",
        "*STEP",
        "*STATIC",
        "*BOUNDARY",
        "HELD, 1, 3",
        *_planes(mesh, planes, axis),
        "TURNED, 1, 1",
        "TURNED, 3, 3",
        *(f"{i + 1}, 2, 2, {DECK_ANGLE_RAD * radius[i]:.12g}" for i in turned),
        "** RF2 at these nodes is tangential",
        "*NODE PRINT, NSET=TURNED, GLOBAL=NO",
        "RF",
        "*END STEP",
    ]
    return "\n".join(lines) + "\n"


def _header(mesh: TetMesh, driven: str, K: float, title: str) -> list[str]:
    copies = 360.0 / mesh.sector_deg
    return [
        "*HEADING",
        # the text of a heading must not look like a keyword or a comment
        " ".join(title.split()).lstrip("* ") or "torsion",
        "** Units: mm, N, MPa.",
        f"** A sector of {mesh.sector_deg:.12g} degrees about z from the x axis,"
        f" 1/{copies:g} of the part;",
        "** antisymmetric planes: on them the displacement is normal to the plane.",
        f"** Patch 'mount' is held; patch '{driven}' turns rigidly about z"
        f" by {DECK_ANGLE_RAD:g} rad.",
        "** Torsional stiffness of the whole part from the printed reactions RF2 [N] at the set"
        " TURNED,",
        "** r = sqrt(x^2 + y^2) [mm] of each node:",
        f"**   K = {copies:g} * sum(r * RF2) / {DECK_ANGLE_RAD * NMM_PER_NM:g}  [N*m/rad]",
        f"** flexspline finds on this mesh: K = {K:.9g} N*m/rad",
        "** (as every mesh, it is too stiff; the part's K and its bounds are in result.json).",
        "** C3D10 has 4 integration points, flexspline's elements have 11: where elements are much curved, K",
        "** differs by some 1e-5 of it.",
    ]


def _planes(mesh: TetMesh, planes: np.ndarray, axis: np.ndarray) -> Iterable[str]:
    if len(planes):
        yield from ("ANTISYMMETRIC, 1, 1", "ANTISYMMETRIC, 3, 3")
    if len(axis):
        # two planes cross in the axis and leave it no freedom; a half model has but one, y = 0
        yield from ("AXIS, 1, 3",) if mesh.sector_deg != 180 else ("AXIS, 1, 1", "AXIS, 3, 3")


def _node_set(name: str, nodes: Sequence[int] | np.ndarray) -> Iterable[str]:
    if not len(nodes):
        return
    yield f"*NSET, NSET={name}"
    numbers = [str(i + 1) for i in nodes]
    for start in range(0, len(numbers), PER_LINE):
        yield ", ".join(numbers[start : start + PER_LINE])
