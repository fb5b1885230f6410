"""CalculiX' stiffness of a body of bricks, condensed to functionals of its displacements.

A functional is {node: (x, y)}: a sum of displacements in the plane, each times its share. Displacement of one
per force of another is all that contact asks of a linear body.
"""

from __future__ import annotations

import os
import subprocess
from math import cos, sin
from pathlib import Path

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix

from flexspline.fea.solid.direct import factorised
from flexspline.fea.types import Elastic

from .mesh import Part, serendipity

Functional = dict[int, tuple[float, float]]
BLOCK = 100
"""Right-hand sides at a time."""


def twins(part: Part) -> dict[int, int]:
    """Of each node at the half's end the one at its beginning, half a turn away."""
    r_and_z = part.polar[:, [0, 2]].tolist()
    begin = {tuple(r_and_z[i]): i for i in np.flatnonzero(part.plane == 0).tolist()}
    return {
        i: begin[tuple(r_and_z[i])] for i in np.flatnonzero(part.plane == 2 * part.around).tolist()
    }


Held = list[tuple[int, int]]
"""Nodes and directions (1, 2, 3) that do not move."""


def deck(part: Part, material: Elastic, held: Held, loads: dict[int, float]) -> str:
    """For CalculiX to assemble, after `loads` {unknown: N} with large displacements if there are any."""
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i},{x:.12g},{y:.12g},{z:.12g}" for i, (x, y, z) in enumerate(part.xyz, 1)]
    lines.append("*ELEMENT, TYPE=C3D20R, ELSET=PART")
    for i, cell in enumerate((part.cells + 1).tolist(), 1):
        lines += [f"{i}," + ",".join(map(str, cell[:10])) + ",", ",".join(map(str, cell[10:]))]
    lines += [
        "*MATERIAL, NAME=M",
        "*ELASTIC",
        f"{material.youngs_modulus_MPa},{material.poissons_ratio}",
    ]
    lines += ["*DENSITY", "1e-9", "*SOLID SECTION, ELSET=PART, MATERIAL=M"]
    for end, begin in twins(part).items():
        for direction, sign in ((1, 1), (2, 1), (3, -1)):
            if (end, direction) not in held:
                lines += [
                    "*EQUATION",
                    "2",
                    f"{end + 1},{direction},1.,{begin + 1},{direction},{sign}.",
                ]
    lines += ["*BOUNDARY", *(f"{node + 1},{direction},{direction}" for node, direction in held)]
    if loads:
        lines += ["*STEP, NLGEOM", "*STATIC", "*CLOAD"]
        lines += [f"{n // 3 + 1},{n % 3 + 1},{force:.9g}" for n, force in loads.items()] + [
            "*END STEP"
        ]
    lines += ["*STEP, PERTURBATION" if loads else "*STEP"]
    lines += ["*FREQUENCY, SOLVER=MATRIXSTORAGE", "1", "*END STEP"]
    return "\n".join(lines) + "\n"


def stiffness(
    part: Part, material: Elastic, held: Held, folder: Path, loads: dict[int, float] | None = None
) -> tuple[csc_matrix, np.ndarray]:
    """The matrix (k, k) [N/mm] that CalculiX assembles, and its unknowns (k,): 3·node + 0, 1, 2.

    Under `loads` it is the tangent: of the deformed part, with the stress in it.
    """
    folder.mkdir()
    (folder / "part.inp").write_text(deck(part, material, held, loads or {}), encoding="utf-8")
    with (folder / "log").open("w", encoding="utf-8") as log:
        subprocess.run(["ccx", "-i", "part"], cwd=folder, env=os.environ | {"OMP_NUM_THREADS": "1"},
                       stdout=log)  # fmt: skip
    row, column, value = np.loadtxt(folder / "part.sti", unpack=True)
    row, column = row.astype(int) - 1, column.astype(int) - 1
    words = (folder / "part.dof").read_text(encoding="utf-8").split()
    node, direction = np.array([word.split(".") for word in words], dtype=int).T
    off = row != column
    both = np.r_[row, column[off]], np.r_[column, row[off]]
    matrix = coo_matrix((np.r_[value, value[off]], both), shape=(len(words), len(words)))
    return matrix.tocsc(), 3 * (node - 1) + direction - 1


def columns(part: Part, unknowns: np.ndarray, functionals: list[Functional]) -> csc_matrix:
    """Functionals as columns over CalculiX' unknowns; the half's end is written by its beginning."""
    place, twin = np.full(3 * len(part.xyz), -1), twins(part)
    place[unknowns] = np.arange(len(unknowns))
    found: list[tuple[int, int, float]] = []
    for k, functional in enumerate(functionals):
        for node, shares in functional.items():
            for d, share in enumerate(shares):
                at, sign = place[3 * node + d], 1.0
                if at < 0 and node in twin:
                    at, sign = place[3 * twin[node] + d], -1.0
                if at >= 0:
                    found.append((int(at), k, sign * share))
    row, column, value = zip(*found, strict=True)
    return coo_matrix((value, (row, column)), shape=(len(unknowns), len(functionals))).tocsc()


def condensed(matrix: csc_matrix, loads: csc_matrix) -> np.ndarray:
    """Functionals' displacement per functionals' force [mm/N]."""
    found = np.zeros((loads.shape[1],) * 2)
    with factorised(matrix.tocsr()) as back:
        for i in range(0, loads.shape[1], BLOCK):
            right = loads[:, i : i + BLOCK].toarray()
            moved = back(right)
            found[:, i : i + BLOCK] = loads.T @ moved
    residual = np.abs(matrix @ moved - right).max() / np.abs(right).max()
    assert residual < 1e-6, residual
    return (found + found.T) / 2


def along(part: Part, weights: dict[int, float], radial: float, tangential: float) -> Functional:
    """radial·u_r + tangential·u_θ, each at its node's own angle."""
    found = {}
    for node, share in weights.items():
        c, s = cos(part.polar[node, 1]), sin(part.polar[node, 1])
        found[node] = share * (radial * c - tangential * s), share * (radial * s + tangential * c)
    return found


def total(parts: list[Functional]) -> Functional:
    found: Functional = {}
    for part in parts:
        for node, (x, y) in part.items():
            a, b = found.get(node, (0.0, 0.0))
            found[node] = a + x, b + y
    return found


def points(
    part: Part, block: str, side: str, round_count: int
) -> list[tuple[dict[int, float], float, float]]:
    """Gauss points of the faces, `round_count` round the axis, two along it: weights, angle, area [mm²]."""
    x, w = np.polynomial.legendre.leggauss(round_count)
    y, v = np.polynomial.legendre.leggauss(2)
    found = []
    for _, _, face in part.faces[block, side]:
        (r, begin, bottom), (_, _, top), (_, end, _) = part.polar[face[:3]]
        area = r * (end - begin) * (top - bottom) / 4
        for a, share in zip(x, w, strict=True):
            for b, other in zip(y, v, strict=True):
                weights = dict(zip(face, serendipity(a, b).tolist(), strict=True))
                found.append(
                    (weights, (begin + end) / 2 + a * (end - begin) / 2, area * share * other)
                )
    return found
