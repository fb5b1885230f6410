"""Netgen on our STEP file, for both peers: faces named, patch edges refined, mesh made.

Runs in an environment with NGSolve; nothing of flexspline is imported here.
"""

from __future__ import annotations

import argparse
import json
import math
from dataclasses import dataclass
from typing import Any

from netgen.occ import OCCGeometry

NEAR = 1e-6


@dataclass(frozen=True)
class Job:
    """What the command line asks for; `edge` is the mesh size [mm] along the patch edges."""

    step: str
    load: str
    sector: float
    order: int
    maxh: float
    edge: float
    grading: float
    patches: dict[str, Any]


def job() -> Job:
    parser = argparse.ArgumentParser()
    parser.add_argument("step")
    parser.add_argument("--load", required=True)
    for name in ("sector", "maxh", "edge", "grading"):
        parser.add_argument(f"--{name}", type=float, required=True)
    parser.add_argument("--order", type=int, required=True)
    parser.add_argument("--patches", type=json.loads, required=True)
    return Job(**vars(parser.parse_args()))


def meshed(j: Job) -> Any:
    """Netgen's mesh, boundaries named mount, mesh, seat, start, end or free."""
    shape = OCCGeometry(j.step).shape
    for face in shape.faces:
        face.name = _patch(face, j)
    circles = _singular(j)
    for edge in shape.edges:
        if any(all(_at(end, r, z) for end in (edge.start, edge.end)) for r, z in circles):
            edge.maxh = j.edge
    return OCCGeometry(shape).GenerateMesh(maxh=j.maxh, grading=j.grading)


def _singular(j: Job) -> list[tuple[float, float]]:
    """Circles (r, z) where the stress that decides is singular; at the open rim held and free surface meet at
    90°, where it is not."""
    p = j.patches
    start = p["ring_z"][0]
    torsion = [
        (p["boss_radius"], 0.0),
        (p["boss_radius"], p["diaphragm"]),
        (p["ring_radius"], start),
    ]
    if j.load == "uniform":
        return torsion
    if j.load == "ellipse":  # its peak lies at the foot of the shoulder, far from the boss
        foot = start - (p["ring_radius"] - p["wall_radius"])
        return [(p["seat_radius"], start), (p["ring_radius"], start), (p["wall_radius"], foot)]
    return [*torsion, (p["seat_radius"], start)]


def _at(point: Any, r: float, z: float) -> bool:
    return abs(math.hypot(point.x, point.y) - r) < NEAR and abs(point.z - z) < NEAR


def _patch(face: Any, j: Job) -> str:
    p = j.patches
    points = [(v.p.x, v.p.y, v.p.z) for v in face.vertices]
    radii, z = [math.hypot(x, y) for x, y, _ in points], [q[2] for q in points]
    if max(map(abs, z)) < NEAR and max(radii) < p["boss_radius"] + NEAR:
        return "mount"
    low, high = p["ring_z"]
    if abs(min(z) - low) < NEAR and abs(max(z) - high) < NEAR:
        for name, radius in (("mesh", p["ring_radius"]), ("seat", p["seat_radius"])):
            if all(abs(r - radius) < NEAR for r in radii):
                return name
    # all corners of a hole's half wall lie in the plane too, its centre does not
    middle = (face.center.x, face.center.y, face.center.z)
    for name, degrees in (("start", 0.0), ("end", j.sector)):
        a = math.radians(degrees)
        off = max(abs(-x * math.sin(a) + y * math.cos(a)) for x, y, _ in [*points, middle])
        if j.sector < 360 and off < NEAR and max(radii) > min(radii) + 1:
            return name
    return "free"


def expected_areas(j: Job) -> dict[str, float]:
    """Areas of the patches on the sector [mm²]: a wrong face would show."""
    p = j.patches
    share = j.sector / 360
    low, high = p["ring_z"]
    around = share * 2 * math.pi * (high - low)
    mount = math.pi * (p["boss_radius"] ** 2 - p["bore_radius"] ** 2)
    mount -= p["holes"] * math.pi * p["hole_radius"] ** 2
    return {
        "mesh": around * p["ring_radius"],
        "seat": around * p["seat_radius"],
        "mount": share * mount,
    }
