"""Hole-free cups, hats and shafts of different proportions, each solved once in a test run: as a
solid with its estimated error, and on its meridian between bounds that are theorems."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import pytest
from example_files import EXAMPLES

from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.solid.defaults import first_spec, surface_to_mesh
from flexspline.fea.solid.mesh import MeshSpec, mesh_surface
from flexspline.fea.solid.stiffness import MeshSequence, solid_stiffness
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.torsion_field import FullTorsion
from flexspline.fea.types import Elastic, Stiffness, TetMesh
from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design
from flexspline.geometry.percent import percent
from flexspline.geometry.symmetry import sector_of

DRIVEN = {"flexspline": "mesh", "shaft": "grip"}
TOLERANCE = 0.005
"""Asked of the solid model: the default of solver.tolerance_pct."""
REFERENCE = 5e-5
"""Width of the two-sided bounds: a hundred times narrower, and eight times below any estimate so far."""
FINE = 0.001
"""A tolerance that takes two or three meshes, where the default often takes one."""
CASES: dict[str, tuple[str, str, dict[str, Any]]] = {
    "cup": ("xb1-40.toml", "flexspline", {}),
    "cup, short and thick": (
        "xb1-40.toml", "flexspline",
        {"length_mm": 18.0, "wall_thickness_mm": 0.9, "ring_thickness_mm": 1.2,
         "diaphragm_thickness_mm": 1.2, "ring_width_mm": 6.0},
    ),
    "cup, long and thin": (
        "xb1-40.toml", "flexspline",
        {"length_mm": 44.0, "wall_thickness_mm": 0.25, "ring_thickness_mm": 0.4,
         "diaphragm_thickness_mm": 0.4, "boss_diameter_mm": 22.0},
    ),
    "cup, ring inboard": ("xb1-40.toml", "flexspline", {"ring_offset_mm": 3.0}),
    "cup, no bore": ("xb1-40.toml", "flexspline", {"bore_diameter_mm": 0.0}),
    "hat": ("hat-25.toml", "flexspline", {}),
    "hat, sharp corners": (
        "hat-25.toml", "flexspline", {"inner_fillet_mm": 0.0, "outer_fillet_mm": 0.0},
    ),
    "hat, thick diaphragm": ("hat-25.toml", "flexspline", {"diaphragm_thickness_mm": 1.2}),
    "shaft, hollow, one step": ("xb1-40.toml", "shaft", {}),
    "shaft, slender": ("xb1-40.toml", "shaft", {"segment": [
        {"length_mm": 3.0, "outer_diameter_mm": 24.0, "inner_diameter_mm": 8.0},
        {"length_mm": 40.0, "outer_diameter_mm": 14.0, "inner_diameter_mm": 8.0}]}),
    "shaft, solid, two steps": ("xb1-40.toml", "shaft", {"segment": [
        {"length_mm": 4.0, "outer_diameter_mm": 26.0, "inner_diameter_mm": 0.0},
        {"length_mm": 10.0, "outer_diameter_mm": 16.0, "inner_diameter_mm": 0.0},
        {"length_mm": 14.0, "outer_diameter_mm": 12.0, "inner_diameter_mm": 0.0}]}),
}  # fmt: skip

DEFAULT = (
    "cup", "cup, no bore", "hat", "hat, sharp corners", "hat, thick diaphragm", "shaft, hollow, one step",
)  # fmt: skip
"""Of each kind of part, those whose bounds come quickest: the others take three to nine seconds each."""
FINE_BY_DEFAULT = "hat, sharp corners"
"""To `FINE`, which takes more than one mesh; the others take one to ten seconds each."""
FTETWILD_BY_DEFAULT = "hat, thick diaphragm"
"""The one on which an estimate from fTetWild's meshes is held to the truth by default."""


def is_long(name: str, kind: str, tolerance: float) -> bool:
    if kind == "fTetWild":
        return name != FTETWILD_BY_DEFAULT
    return name not in DEFAULT if tolerance == TOLERANCE else name != FINE_BY_DEFAULT


SOLUTIONS = [
    pytest.param(
        name, kind, tolerance, id=f"{kind}, to {percent(tolerance)}-{name}",
        marks=[pytest.mark.long] * is_long(name, kind, tolerance),
    )
    for kind, tolerance in (("chosen", TOLERANCE), ("chosen", FINE), ("fTetWild", TOLERANCE))
    for name in CASES
]  # fmt: skip
"""Case, mesher, tolerance."""


def hole_free(file: str, part: str, changes: dict[str, Any]) -> Design:
    """With other values at some keys of a part."""
    plain = {"flexspline.bolt_count": 0, "shaft.bolt_count": 0, "shaft.keyway": None}
    own = {f"{part}.{key}": value for key, value in changes.items()}
    return load_design(EXAMPLES / file).changed({**plain, **own})


@dataclass(frozen=True)
class Pair:
    """The solid model's answer and the bounds it is judged by."""

    solid: Stiffness
    exact: Stiffness

    @property
    def estimated_error(self) -> float:
        """The estimate of K_h − K on the finest mesh, N·m/rad."""
        return self.solid.upper_Nm_per_rad - self.solid.K_Nm_per_rad

    @property
    def true_error(self) -> float:
        """K_h − K on the finest mesh, N·m/rad, with the bounds' middle for K."""
        return self.solid.levels[-1].K_Nm_per_rad - self.exact.K_Nm_per_rad


def mesher(design: Design, part: str, kind: str) -> Callable[[MeshSpec], TetMesh]:
    """The program's own choice ("chosen": swept where the part allows it), or always "fTetWild"."""
    degrees = sector_of(design.part(part), "torsion").degrees
    first = first_spec(design.part(part))
    if kind == "chosen" and swept_mesh(design.part(part), degrees, first) is not None:

        def swept(spec: MeshSpec) -> TetMesh:
            mesh = swept_mesh(design.part(part), degrees, spec)
            assert mesh is not None
            return mesh

        return swept
    surface = surface_to_mesh(
        design.part(part), first_spec(design.part(part)), degrees, edge_spacing=0.1
    )
    return lambda spec: mesh_surface(surface, spec)


@cache
def solved(name: str, kind: str = "chosen", tolerance: float = TOLERANCE) -> Pair:
    """Both solutions of a case."""
    file, part, changes = CASES[name]
    design = hole_free(file, part, changes)
    material = Elastic.of(design.material.flexspline)
    found = solid_stiffness(
        MeshSequence(mesher(design, part, kind), first_spec(design.part(part))),
        FullTorsion(material, DRIVEN[part]), tolerance, "1/12", print,
    ).stiffness  # fmt: skip
    exact = torsional_stiffness(design.part(part).meridian, material, DRIVEN[part], REFERENCE)
    return Pair(found, exact)
