"""K_b by NGSolve: curved tetrahedra of the given order, static condensation, its sparse Cholesky.

On a wedge the in-plane displacement of the symmetry planes is suppressed by a penalty.
"""

from __future__ import annotations

import json
import math
import time

BEGAN = time.perf_counter()

from ngsolve import (  # noqa: E402
    BND,
    CF,
    BilinearForm,
    GridFunction,
    InnerProduct,
    Integrate,
    Mesh,
    Sym,
    TaskManager,
    VectorH1,
    div,
    ds,
    dx,
    specialcf,
    x,
    y,
)
from ngsolve import Grad as grad  # noqa: E402
from peer_geometry import expected_areas, job, meshed  # noqa: E402

PENALTY = 1e6
"""Over E, per mm. Ten times less changes K by 1e-6."""


def main() -> None:
    j = job()
    imported = time.perf_counter()
    mesh = Mesh(meshed(j))  # Netgen is slower, not faster, among the task manager's threads
    made = time.perf_counter()
    with TaskManager():
        mesh.Curve(j.order)
        for name, wanted in expected_areas(j).items():
            area = Integrate(CF(1), mesh, BND, definedon=mesh.Boundaries(name))
            if abs(area / wanted - 1) > 1e-3:
                raise SystemExit(f"patch {name} has {area:.6g} mm², expected {wanted:.6g}")
        E, nu = j.patches["E"], j.patches["nu"]
        mu, lam = E / 2 / (1 + nu), E * nu / (1 + nu) / (1 - 2 * nu)
        space = VectorH1(mesh, order=j.order, dirichlet="mount|mesh")
        u, v = space.TnT()
        a = BilinearForm(space, symmetric=True, condense=True)
        a += (2 * mu * InnerProduct(Sym(grad(u)), Sym(grad(v))) + lam * div(u) * div(v)) * dx
        if j.sector < 360:
            n = specialcf.normal(3)
            a += PENALTY * E * InnerProduct(u - (u * n) * n, v - (v * n) * n) * ds("start|end")
        a.Assemble()
        assembled = time.perf_counter()
        turned = GridFunction(space)
        turned.Set(CF((-y, x, 0)), definedon=mesh.Boundaries("mesh"))
        right = turned.vec.CreateVector()
        right.data = -a.mat * turned.vec
        right.data += a.harmonic_extension_trans * right
        turned.vec.data += a.mat.Inverse(space.FreeDofs(True), "sparsecholesky") * right
        turned.vec.data += a.harmonic_extension * turned.vec
        strain, divergence = Sym(grad(turned)), div(turned)
        energy = 2 * mu * InnerProduct(strain, strain) + lam * divergence**2
        torque = Integrate(energy, mesh) * 360 / j.sector
    print()
    print(json.dumps({
        "K": torque / 1000, "unknowns": space.ndof, "elements": mesh.ne,
        "stages_s": {
            "import": round(imported - BEGAN, 2), "mesh": round(made - imported, 2),
            "assembly": round(assembled - made, 2),
            "solve": round(time.perf_counter() - assembled, 2),
        },
    }))  # fmt: skip
    assert math.isfinite(torque)


main()
