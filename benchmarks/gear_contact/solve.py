"""A whole gear with its wave generator locked, in three dimensions, beside `flexspline gear`.

    apt-get install calculix-ccx
    python3 -m benchmarks.gear_contact.solve            all meshes, some 20 minutes of one core
    python3 -m benchmarks.gear_contact.solve coarse     one mesh, 3 minutes

CalculiX assembles the stiffness of the flexspline and of the outer race from bricks with 20 nodes, half of
each: what stands half a turn away moves alike. It is condensed to the pitch points of the teeth, to Gauss
points of the seat and to the balls' grooves. Contact forces at a given turn of the output are Lawson and
Hanson's nonnegative least squares (scipy.optimize.nnls), Hertz's law of the balls by its tangent, again and
again. No harmonics, no places along the seat, no interior point method.

From flexspline come the laws that both models assume: gaps of the unloaded flanks, compliance of one pair of
teeth and of one ball. Written to record.json; docs/whole-gear.md shows it.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
import tomllib
from dataclasses import dataclass, replace
from itertools import pairwise
from math import cos, pi, sin, tan
from pathlib import Path

import numpy as np
import scipy
from scipy.sparse import csc_matrix

from flexspline.fea.gear.model import GearModel
from flexspline.fea.types import Elastic
from flexspline.geometry.design import Design
from flexspline.geometry.load import design_from
from flexspline.geometry.material import BEARING_STEEL
from flexspline.geometry.sized import sized_template
from flexspline.geometry.wave_generator import flexible_bearing
from flexspline.pipeline.gear.gear_model import GROOVE_SHARE, gear_model

from . import stiffness as stiff
from .forces import Problem
from .mesh import INSIDE, OUTSIDE, Part, cup, hoop

RESULTS = Path(__file__).with_name("record.json")
SIZE, RATIO = 14, 50
CHANGED = {"flexspline.bolt_count": 0, "flexspline.inner_fillet_mm": 0.0, "flexspline.outer_fillet_mm": 0.0,
           "flexspline.wall_thickness_mm": 0.3556, "flexspline.diaphragm_thickness_mm": 0.5334,
           "gear.flank_clearance_um": 30.0}  # fmt: skip
"""A body of revolution with sharp corners and walls in proportion to examples/xb1-40.toml; so much clearance
that teeth are free on the rigid plug too."""
SEAT_PRESSURE = 1e6
"""Pressure per penetration of the seat [MPa/mm]: 100 MPa, as at its inner edge, are 0.1 µm."""
SLICES = 3
"""Of a tooth's face, each of which can also be a spring of its own."""
TURNS = {
    "plug": (4e-4, 7.9e-4, 1.24e-3, 1.66e-3, 2.08e-3),
    "race": (1.2e-3, 1.65e-3, 1.93e-3, 2.19e-3, 2.6e-3, 2.94e-3),
}
"""Of the output [rad], about 1 to 16 N·m."""


@dataclass(frozen=True)
class Mesh:
    """Bricks in half a turn, bricks through the wall, contact points of a brick round the axis."""

    around: int
    fine: int
    contact: int


MESHES = {"coarse": Mesh(50, 1, 2), "round": Mesh(100, 1, 1), "along": Mesh(50, 2, 1)}


def design() -> Design:
    """That of `flexspline init cup --size 14 --ratio 50`, as a body of revolution with thicker walls."""
    return design_from(tomllib.loads(sized_template("cup", SIZE, RATIO))).changed(CHANGED)


def tooth_functionals(of: Design, model: GearModel, rim: Part) -> list[stiff.Functional]:
    """How far the gap of a slice of a flank closes: front flanks tooth by tooth, then back flanks.

    The tooth is rigid on its root, as wide as straight flanks make it there: its pitch point moves with the
    root's mean displacement and turns with the root's slope.
    """
    f, mesh, module = of.flexspline, model.mesh, of.gear.module_mm
    alpha, root = mesh.pressure_angle, f.ring_radius
    half = (pi * module / 4 + (mesh.pitch_radius - root) * tan(alpha)) / root
    lift = (mesh.pitch_radius - root) / root
    edges = np.linspace(f.ring_start, f.ring_end, SLICES + 1)
    found = []
    for sign in (1, -1):
        for phi in model.tooth_angles.tolist():
            for low, high in pairwise(edges):
                found.append(stiff.total([
                    stiff.along(rim, rim.weights("ring", OUTSIDE, phi + angle, low, high), radial, tangential)
                    for angle, radial, tangential in root_rule(alpha, half, lift, sign)
                ]))  # fmt: skip
    return found


def root_rule(
    alpha: float, half: float, lift: float, sign: int
) -> list[tuple[float, float, float]]:
    """Angle from the tooth's middle, share of u_r, share of u_θ in u_r sin α ± u_pitch cos α."""
    x, w = np.polynomial.legendre.leggauss(4)
    rule = [
        (half * at, sin(alpha) * share / 2, sign * cos(alpha) * (1 + lift) * share / 2)
        for at, share in zip(x.tolist(), w.tolist(), strict=True)
    ]
    slope = sign * cos(alpha) * lift / (2 * half)
    return [*rule, (half, -slope, 0.0), (-half, slope, 0.0)]


@dataclass(frozen=True)
class Rim:
    """The flexspline, seen from slices of flanks and from points of the seat.

    Attributes
    ----------
    compliance : (k, k) gap per force [mm/N]: slices, then points.
    seat, area : of the points, angle [rad] and area [mm²].
    loads : (unknowns, k) nodal forces per contact force.
    """

    compliance: np.ndarray
    seat: np.ndarray
    area: np.ndarray
    loads: csc_matrix
    unknowns: np.ndarray
    bricks: int


def rim_of(
    of: Design, model: GearModel, mesh: Mesh, folder: Path, loads: dict[int, float] | None = None
) -> Rim:
    """As drawn, or, under `loads`, deformed and with its stress."""
    f = of.flexspline
    rim = Part(cup(f, mesh.fine), mesh.around)
    on_mount = (rim.polar[:, 2] == 0) & (rim.polar[:, 0] < f.boss_diameter_mm / 2 + 1e-6)
    held = [(node, d) for node in np.flatnonzero(on_mount).tolist() for d in (1, 2, 3)]
    material = Elastic.of(of.material.flexspline)
    matrix, unknowns = stiff.stiffness(rim, material, held, folder, loads)
    seat = stiff.points(rim, "ring", INSIDE, mesh.contact)
    # a tooth that moves outwards closes its gap, a rim that does opens it
    teeth = tooth_functionals(of, model, rim)
    rows = [{n: (-x, -y) for n, (x, y) in tooth.items()} for tooth in teeth]
    rows += [stiff.along(rim, weights, 1.0, 0.0) for weights, _, _ in seat]
    columns = stiff.columns(rim, unknowns, rows)
    angle, area = (np.array([point[i] for point in seat]) for i in (1, 2))
    return Rim(stiff.condensed(matrix, columns), angle, area, columns, unknowns, len(rim.cells))


def race_compliance(of: Design, angles: np.ndarray, mesh: Mesh, folder: Path) -> np.ndarray:
    """Gap per force [mm/N] that the outer race adds: outside at the seat points, groove at each ball."""
    f, bearing = of.flexspline, flexible_bearing(of)
    ring = Part(hoop(f, bearing.race_thickness, mesh.fine), mesh.around)
    middle = (f.ring_start + f.ring_end) / 2
    groove = min(GROOVE_SHARE * bearing.ball_diameter, f.ring_width_mm / 2) / 2
    on_axis = (ring.plane == ring.around) & (np.abs(ring.polar[:, 2] - middle) < 1e-6)
    node = int(np.flatnonzero(on_axis)[0])  # held there it neither turns nor drifts along the axis
    matrix, unknowns = stiff.stiffness(
        ring, Elastic.of(BEARING_STEEL), [(node, 2), (node, 3)], folder
    )
    outside = stiff.points(ring, "hoop", OUTSIDE, mesh.contact)
    rows = [stiff.along(ring, weights, -1.0, 0.0) for weights, _, _ in outside]
    for angle in angles.tolist():
        weights = ring.weights("hoop", INSIDE, angle, middle - groove, middle + groove)
        rows.append(stiff.along(ring, weights, 1.0, 0.0))
    return stiff.condensed(matrix, stiff.columns(ring, unknowns, rows))


def problem(
    of: Design,
    model: GearModel,
    rim: Rim,
    race: np.ndarray | None,
    slices: int,
    relieved: bool = False,
) -> Problem:
    """`slices` 1: a tooth is loaded evenly over its face. `relieved`: slices are, for the cone."""
    wave, teeth = model.wave_generator, 2 * len(model.tooth_angles)
    points, angles = len(rim.seat), ball_angles(model)
    own = rim.compliance
    if slices == 1:  # a tooth's gap is the mean of its slices', its force is shared evenly
        gather = np.eye(teeth * SLICES + points)
        mean = gather[: teeth * SLICES].reshape(teeth, SLICES, -1).mean(axis=1)
        gather = np.vstack([mean, gather[teeth * SLICES :]])
        own = gather @ own @ gather.T
    flanks = teeth * slices
    k = flanks + points + (0 if race is None else len(angles))
    compliance, gap, hertz, turning = np.zeros((k, k)), np.zeros(k), np.zeros(k), np.zeros(k)
    compliance[: flanks + points, : flanks + points] = own
    further = [np.full(flanks, model.pair * slices), 1 / (SEAT_PRESSURE * rim.area)]
    compliance[np.arange(flanks + points), np.arange(flanks + points)] += np.concatenate(further)
    gap[:flanks] = np.repeat(model.contacts.free[model.flanks], slices)
    if relieved:
        gap[:flanks] += relief(of, model)
    arm = model.mesh.pitch_radius * cos(model.mesh.pressure_angle)
    turning[:flanks] = np.repeat([-arm, arm], flanks // 2)
    plug = wave.play / 2 - wave.deflection * np.cos(2 * (rim.seat if race is None else angles))
    gap[k - len(plug) :] = plug
    if race is not None:
        compliance[flanks:, flanks:] += race
        hertz[k - len(angles) :] = wave.hertz
    return Problem(compliance, gap, hertz, turning, flanks, slices, rim.seat)


def relief(of: Design, model: GearModel) -> np.ndarray:
    """Of each slice, front flanks, then back [mm]: the law that the contact model has for its own places.

    Three places are hats over z whose centroids are the middles of the thirds.
    """
    own = gear_model(of, of.part("flexspline"), face_places=SLICES)
    cone = own.rim.cone(own.mesh.stroke)
    return np.array(own.mesh.closing(model.tooth_angles[:, None], *cone)).ravel()


def ball_angles(model: GearModel) -> np.ndarray:
    """Between −π/2 and π/2 [rad]."""
    return (model.wave_generator.angles + pi / 2) % pi - pi / 2


def stretched(
    of: Design, model: GearModel, mesh: Mesh, rim: Rim, race: np.ndarray, folder: Path
) -> Problem:
    """The gear on its race about the state in which teeth are still free: tangent of large displacements."""
    plain = problem(of, model, rim, race, 1)
    pushed = plain.forces(0.0)[plain.flanks : plain.flanks + len(rim.seat)]
    nodal = rim.loads[:, -len(pushed) :] @ pushed
    loads = {int(n): float(f) for n, f in zip(rim.unknowns, nodal, strict=True) if f}
    tangent = problem(of, model, rim_of(of, model, mesh, folder, loads), race, 1)
    here = np.zeros(len(plain.gap))
    here[plain.flanks : plain.flanks + len(rim.seat)] = pushed
    # both agree in that state
    return replace(tangent, gap=plain.gap + (plain.compliance - tangent.compliance) @ here)


def solved(name: str) -> dict:
    """All curves on one mesh; what changes an assumption on the coarse one."""
    began, mesh, of = time.perf_counter(), MESHES[name], design()
    model = replace(gear_model(of, of.part("flexspline"), face_places=1), spline=None)
    with tempfile.TemporaryDirectory() as folder:
        rim = rim_of(of, model, mesh, Path(folder, "rim"))
        race = race_compliance(of, ball_angles(model), mesh, Path(folder, "race"))
        problems = {
            "plug": problem(of, model, rim, None, 1),
            "race": problem(of, model, rim, race, 1),
        }
        if name == "coarse":
            problems |= {
                f"plug, {SLICES} slices": problem(of, model, rim, None, SLICES),
                f"race, {SLICES} slices": problem(of, model, rim, race, SLICES),
                f"race, {SLICES} slices, relieved": problem(
                    of, model, rim, race, SLICES, relieved=True
                ),
                "race, stretched": stretched(of, model, mesh, rim, race, Path(folder, "stretched")),
            }
    sizes = {"bricks": rim.bricks, "unknowns": len(rim.unknowns), "seat_points": len(rim.seat)}
    print(name, sizes, f"{time.perf_counter() - began:.0f} s", flush=True)
    curves = {}
    for key, one in problems.items():
        curves[key] = one.curve(TURNS[key.split(",")[0]])
        print(key, [round(p["torque_Nm"], 4) for p in curves[key]], flush=True)
    return sizes | {"seconds": round(time.perf_counter() - began), "curves": curves}


def versions() -> dict[str, str]:
    said = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout
    return {"CalculiX": said.split()[-1], "scipy": scipy.__version__, "numpy": np.__version__}


def main() -> None:
    for name in sys.argv[1:] or MESHES:
        found = solved(name)
        record = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
        record |= {"size": SIZE, "ratio": RATIO, "changed": CHANGED, "versions": versions()}
        record["meshes"] = record.get("meshes", {}) | {name: found}
        RESULTS.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
