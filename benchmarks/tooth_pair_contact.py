"""Meshed teeth in contact: NGSolve on a section of the gear beside `fea.gear.tooth_pair`.

    pip install -e '.[bench]'
    python3 benchmarks/tooth_pair_contact.py        two minutes; writes tooth_pair_contact.json

Two toothed strips in plane strain, the teeth of benchmarks/gear_contact/solve.py. Their backs slide on rigid
supports, their ends are held; one is shifted until one pair of flanks pushes. The shift, less what both
strips stretch as bars, is what that pair yields: both teeth, their roots, the contact. The bar's stiffness is
that of the same meshed strip, pulled. The model has no strip: below its teeth is a half plane.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from importlib.metadata import version
from math import cos, pi, sin, sqrt, tan
from pathlib import Path

import ngsolve as ngs
from gear_contact import solve as gear
from netgen import occ

from flexspline.fea.types import Elastic
from flexspline.geometry.basic_rack import ADDENDUM
from flexspline.geometry.design import Design
from flexspline.pipeline.gear.gear_model import pair_compliance

RESULTS = Path(__file__).with_suffix(".json")
BEHIND_mm = (None, 1.5, 3.0)
"""Thickness of the strip behind the teeth; None: the design's ring."""
CROWNS_mm = (None, 20.0, 2.0)
"""Radius of one flank; None: both straight, so that they touch from tip to tip."""
LOADS_N_mm = (5.0, 20.0)
"""Sought normal force per width: 5 and 20 N/mm are a few and some 20 N·m of this gear."""
BESIDE = 4
"""Teeth on each side of the loaded one; 8 move the pair's compliance by 3 % of itself."""
FLANK_mm, COARSE_mm, ORDER = 0.012, 0.15, 3
PENALTY = 2e8
"""Pressure per penetration [MPa/mm]."""
SETTLED = 1e-10
"""Square root of the energy that a Newton step still sets free [N mm per mm width]."""


@dataclass(frozen=True)
class Teeth:
    """Straight-sided teeth on a strip; lengths [mm], angle [rad], `lever` from the root to the pitch line."""

    module: float
    angle: float
    lever: float

    @classmethod
    def of(cls, design: Design) -> Teeth:
        g = design.gear
        pitch = g.module_mm * g.teeth_flexspline / 2
        return cls(
            g.module_mm, g.pressure_angle_deg * pi / 180, pitch - design.flexspline.ring_radius
        )

    @property
    def half_strip(self) -> float:
        return (BESIDE + 0.5) * pi * self.module

    @property
    def tip(self) -> float:
        return self.lever + ADDENDUM * self.module

    def strip(self, behind: float) -> occ.Shape:
        """Teeth upwards from y = 0, the middle one at x = 0."""
        half = self.half_strip
        found = occ.MoveTo(-half, -behind).Rectangle(2 * half, behind).Face()
        for k in range(-BESIDE, BESIDE + 1):
            x, root, top = k * pi * self.module, self.half_width(0), self.half_width(self.tip)
            found += (
                occ.MoveTo(x - root, 0).LineTo(x + root, 0).LineTo(x + top, self.tip)
                .LineTo(x - top, self.tip).Close().Face()
            )  # fmt: skip
        return found

    def half_width(self, y: float) -> float:
        return pi * self.module / 4 + (self.lever - y) * tan(self.angle)

    def pair(self, behind: float) -> ngs.Mesh:
        """Two strips whose middle teeth touch with one flank each; the other teeth do not see each other."""
        apart = pi * self.module / 2
        lower = self.strip(behind)
        upper = self.strip(behind).Rotate(occ.Axis((0, 0, 0), occ.Z), 180)
        upper = upper.Move((apart, 2 * self.lever, 0))
        for body, name in ((lower, "lower"), (upper, "upper")):
            for edge in body.edges:
                x, y = edge.center.x, edge.center.y
                if name == "upper":
                    x, y = apart - x, 2 * self.lever - y
                edge.name = "free"
                if abs(abs(x) - self.half_strip) < 1e-6:
                    edge.name = f"{name} end"
                elif abs(y + behind) < 1e-6:
                    edge.name = f"{name} back"
                elif 0 < x < 2 * apart and abs(y - self.tip / 2) < 1e-6:
                    edge.name, edge.maxh = f"{name} flank", FLANK_mm
        both = occ.OCCGeometry(occ.Compound([lower, upper]), dim=2)
        return ngs.Mesh(both.GenerateMesh(maxh=COARSE_mm, grading=0.25))


class Section:
    """The two strips with their elastic energy, per mm of width."""

    def __init__(self, teeth: Teeth, behind: float, material: Elastic):
        self.teeth, self.mesh = teeth, teeth.pair(behind)
        ends = "lower end|upper end"
        self.space = ngs.VectorH1(
            self.mesh, order=ORDER, dirichletx=ends, dirichlety=f"{ends}|lower back|upper back"
        )
        self.u = self.space.TrialFunction()
        young, nu = material.youngs_modulus_MPa, material.poissons_ratio
        shear, lame = young / (2 * (1 + nu)), young * nu / ((1 + nu) * (1 - 2 * nu))
        strain = ngs.Sym(ngs.Grad(self.u))
        self.energy = (
            shear * ngs.InnerProduct(strain, strain) + lame / 2 * ngs.Trace(strain) ** 2
        ) * ngs.dx
        half = teeth.half_strip
        form = self.form()
        pulled = self.moved(form, "lower end", ngs.CF((ngs.x / half, 0)))  # by 2 mm
        self.stretch = half / 2 / (form.Energy(pulled.vec) * half)
        """Of a strip held at both ends and pushed in its middle [mm²/N]."""

    def form(self) -> ngs.BilinearForm:
        found = ngs.BilinearForm(self.space)
        found += ngs.Variation(self.energy)
        return found

    def moved(
        self, form: ngs.BilinearForm, where: str, by: ngs.CoefficientFunction
    ) -> ngs.GridFunction:
        """Newton's method from the state in which only `where` has moved."""
        found = ngs.GridFunction(self.space)
        found.Set(by, definedon=self.mesh.Boundaries(where))
        step, residual = found.vec.CreateVector(), found.vec.CreateVector()
        for _ in range(100):
            form.AssembleLinearization(found.vec)
            form.Apply(found.vec, residual)
            step.data = form.mat.Inverse(self.space.FreeDofs(), "sparsecholesky") * residual
            found.vec.data -= step
            if sqrt(abs(ngs.InnerProduct(step, residual))) < SETTLED:
                return found
        raise RuntimeError("contact does not settle")

    def pair_compliance(self, crown: float | None, load: float) -> tuple[float, float]:
        """Of the pair of teeth [mm²/N], secant, and the normal force per width [N/mm], near `load`."""
        teeth, form = self.teeth, self.form()
        touch = ngs.ContactBoundary(
            self.mesh.Boundaries("lower flank"), self.mesh.Boundaries("upper flank")
        )
        normal = ngs.CF((cos(teeth.angle), sin(teeth.angle)))
        along = (ngs.y - teeth.lever) / cos(teeth.angle)
        gap = 0.0 if crown is None else along**2 / (2 * crown)
        depth = (self.u - self.u.Other()) * normal - gap
        touch.AddEnergy(ngs.IfPos(depth, PENALTY / 2 * depth**2, 0))
        start = ngs.GridFunction(self.space)
        touch.Update(start, form, intorder=12, maxdist=teeth.module / 2)
        shift = 6e-5 * load  # of both strips and a pair, near enough
        moved = self.moved(form, "upper end", ngs.CF((-shift, 0)))
        residual, unit = start.vec.CreateVector(), ngs.GridFunction(self.space)
        form.Apply(moved.vec, residual)
        unit.Set(ngs.CF((1, 0)), definedon=self.mesh.Boundaries("upper end"))
        push = -ngs.InnerProduct(residual, unit.vec)
        normal_force = push / cos(teeth.angle)
        closing = (shift - 2 * self.stretch * push) * cos(teeth.angle)
        return closing / normal_force, normal_force


def main() -> None:
    """Every strip, every crown, every load."""
    design = gear.design()
    f, teeth = design.flexspline, Teeth.of(design)
    material = Elastic.of(design.material.flexspline)
    rows = []
    with ngs.TaskManager(pajetrace=0):
        for given in BEHIND_mm:
            behind = given or f.ring_thickness_mm
            section = Section(teeth, behind, material)
            for crown in CROWNS_mm:
                for load in LOADS_N_mm:
                    compliance, force = section.pair_compliance(crown, load)
                    row = {
                        "behind_mm": behind, "crown_mm": crown,
                        "unknowns": section.space.ndof,
                        "force_N_mm": force, "compliance_mm2_N": compliance,
                    }  # fmt: skip
                    print(row, flush=True)
                    rows.append(row)
    record = {
        "ngsolve": version("ngsolve"),
        "size": gear.SIZE,
        "ratio": gear.RATIO,
        "model_mm2_N": pair_compliance(design) * f.ring_width_mm,
        "pairs": rows,
    }
    RESULTS.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
