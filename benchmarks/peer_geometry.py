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
    sector: float
    order: int
    maxh: float
    edge: float
    grading: float
    patches: dict[str, Any]


def job() -> Job:
    parser = argparse.ArgumentParser()
    parser.add_argument("step")
    for name in ("sector", "maxh", "edge", "grading"):
        parser.add_argument(f"--{name}", type=float, required=True)
    parser.add_argument("--order", type=int, required=True)
    parser.add_argument("--patches", type=json.loads, required=True)
    return Job(**vars(parser.parse_args()))


def meshed(j: Job) -> Any:
    """Netgen's mesh, boundaries named mount, mesh, start, end or free."""
    shape = OCCGeometry(j.step).shape
    p = j.patches
    for face in shape.faces:
        face.name = _patch(face, j)
    corners = [
        (p["boss_radius"], 0.0),
        (p["boss_radius"], p["diaphragm"]),
        (p["ring_radius"], p["ring_z"][0]),
    ]
    for edge in shape.edges:
        # circles where the torsional stress is singular: rim of the mount, inside corner, start of
        # the ring; at the open rim held and free surface meet at 90°, which is not
        if any(all(_at(end, r, z) for end in (edge.start, edge.end)) for r, z in corners):
            edge.maxh = j.edge
    return OCCGeometry(shape).GenerateMesh(maxh=j.maxh, grading=j.grading)


def _at(point: Any, r: float, z: float) -> bool:
    return abs(math.hypot(point.x, point.y) - r) < NEAR and abs(point.z - z) < NEAR


def _patch(face: Any, j: Job) -> str:
    p = j.patches
    points = [(v.p.x, v.p.y, v.p.z) for v in face.vertices]
    radii, z = [math.hypot(x, y) for x, y, _ in points], [q[2] for q in points]
    if max(map(abs, z)) < NEAR and max(radii) < p["boss_radius"] + NEAR:
        return "mount"
    low, high = p["ring_z"]
    outer = min(radii) > p["ring_radius"] - NEAR
    if outer and abs(min(z) - low) < NEAR and abs(max(z) - high) < NEAR:
        return "mesh"
    # all corners of a hole's half wall lie in the plane too, its centre does not
    middle = (face.center.x, face.center.y, face.center.z)
    for name, degrees in (("start", 0.0), ("end", j.sector)):
        a = math.radians(degrees)
        off = max(abs(-x * math.sin(a) + y * math.cos(a)) for x, y, _ in [*points, middle])
        if j.sector < 360 and off < NEAR and max(radii) > min(radii) + 1:
            return name
    return "free"


def expected_areas(j: Job) -> dict[str, float]:
    """Areas of the driven and the held patch on the sector [mm²]: a wrong face would show."""
    p = j.patches
    share = j.sector / 360
    low, high = p["ring_z"]
    ring = 2 * math.pi * p["ring_radius"] * (high - low)
    mount = math.pi * (p["boss_radius"] ** 2 - p["bore_radius"] ** 2)
    mount -= p["holes"] * math.pi * p["hole_radius"] ** 2
    return {"mesh": share * ring, "mount": share * mount}
