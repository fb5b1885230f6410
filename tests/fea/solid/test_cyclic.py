"""Two-lobed loads by waves on half a repeat.

Three ways to know that the waves are right:

- The quarter or half of the part, the same mesh unfolded, by plane symmetry alone: the same answer to
  rounding, for every number of holes and both kinds of load.
- The harmonics of a body of revolution, which know no repeats: without holes a part has as many as one likes.
- The waves of a function add up to it on every copy of half a repeat.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from math import pi, sqrt

import numpy as np
import pytest
from example_files import EXAMPLES
from lobe_stiffness import lobe_stiffness

from flexspline.fea.solid.cyclic import half_repeat, repeats_of
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.load_cases import ellipse, lobes
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.solved import Solved, SolvedStiffness
from flexspline.fea.solid.solver import ITERATION_ENERGY
from flexspline.fea.solid.stress import energy_error
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.unfold import unfolded
from flexspline.fea.solid.waves import waves
from flexspline.fea.types import Elastic, TetMesh
from flexspline.geometry.load import design_from
from flexspline.geometry.part import Part

EXAMPLE = EXAMPLES / "xb1-40.toml"
STEEL = Elastic(206e3, 0.3)
SHORT = {
    "length_mm": 18.0, "wall_thickness_mm": 0.9, "ring_thickness_mm": 1.2, "ring_width_mm": 6.0,
    "diaphragm_thickness_mm": 1.2,
}  # fmt: skip
"""A thick cup, which few elements fill."""
ROUNDING = 1e-8
"""Of K: solutions are good to 1e-9 where a free rim is a hundred times softer than the part in torsion."""
CASES: dict[str, Callable[[Model], Solved]] = {
    "lobes": lambda model: lobes(model, True),
    "lobes, rim free": lambda model: lobes(model, False),
    "ellipse": lambda model: ellipse(model, 0.2),
}


@cache
def part(holes: int, bore_mm: float = 8.0) -> Part:
    data = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    data["flexspline"] |= SHORT | {"bolt_count": holes, "bore_diameter_mm": bore_mm}
    return design_from(data).part("flexspline")


@cache
def half(holes: int, bore_mm: float = 8.0) -> TetMesh:
    """Half a repeat, coarse."""
    own = part(holes, bore_mm)
    spec = replace(first_spec(own), grading=Grading(4.0, 12.0, 1.0))
    found = swept_mesh(own, 180.0 / holes, spec)
    assert found is not None
    return found


def larger(mesh: TetMesh) -> TetMesh:
    """The part's quarter, its half where the repeats are odd: one or two repeats are left."""
    return unfolded(mesh, 180.0 if repeats_of(mesh) % 2 else 90.0)


@cache
def models(holes: int) -> tuple[Model, Model]:
    """Of half a repeat, and of the quarter or half."""
    return Model.of(half(holes), STEEL), Model.of(larger(half(holes)), STEEL)


def agree(found: Solved, known: Solved, energy: float = ROUNDING) -> None:
    """`energy`: relative, that K may be off by."""
    assert type(found) is type(known)
    if isinstance(found, SolvedStiffness) and isinstance(known, SolvedStiffness):
        assert found.K_energy == pytest.approx(known.K_energy, rel=energy)
        assert found.K_check == pytest.approx(known.K_check, rel=energy)
    np.testing.assert_array_equal(found.mesh.cells, known.mesh.cells)
    apart = np.linalg.norm(found.displacement - known.displacement)
    # energy is quadratic in what is off; rounding is far below that
    allowed = 1e-6 if energy == ROUNDING else sqrt(energy)
    assert apart < allowed * np.linalg.norm(known.displacement)


@pytest.mark.parametrize(
    ("holes", "case"),
    [
        (4, "lobes"),
        (5, "lobes, rim free"),
        (5, "ellipse"),
        *(
            pytest.param(holes, case, marks=pytest.mark.long)
            for holes in (3, 4, 5, 8)
            for case in CASES
            if holes in (3, 8) or (case == "lobes") is (holes == 5)
        ),
    ],
)
def test_waves_give_what_the_quarter_or_half_gives(holes: int, case: str) -> None:
    model, whole = models(holes)
    assert repeats_of(model.mesh) == holes
    known = CASES[case](whole)
    found = CASES[case](model)
    agree(found, known)
    # the lobes' waves are all of the quarter's fields, the ellipse is one of them
    assert found.dofs == known.dofs if case != "ellipse" else found.dofs <= known.dofs


@pytest.mark.parametrize("case", [pytest.param("lobes", marks=pytest.mark.long), "ellipse"])
def test_iteration_gives_what_factors_give(case: str) -> None:
    model, _ = models(5)
    direct = CASES[case](replace(model, solve_by="direct"))
    iterated = CASES[case](replace(model, solve_by="iterative"))
    assert (direct.solver, iterated.solver) == ("direct", "iterative")
    agree(iterated, direct, ITERATION_ENERGY)


@pytest.mark.parametrize("holes", [3, pytest.param(4, marks=pytest.mark.long)])
def test_a_part_with_an_axis(holes: int) -> None:
    """Of an odd number of repeats half the part is solved: a wave of order 1 moves the axis."""
    mesh = half(holes, bore_mm=0.0)
    own = half_repeat(mesh)
    assert own.sector_deg == (180.0 if holes == 3 else mesh.sector_deg)
    assert half_repeat(half(holes)) is half(holes)
    agree(lobes(Model.of(own, STEEL), False), lobes(Model.of(larger(mesh), STEEL), False))


@pytest.mark.parametrize(
    ("repeats", "supported"),
    [
        (5, False),
        *(
            pytest.param(repeats, supported, marks=pytest.mark.long)
            for repeats, supported in ((12, False), (5, True), (12, True))
        ),
    ],
)
def test_repeats_of_a_body_of_revolution_mean_nothing(repeats: int, supported: bool) -> None:
    body = part(0)
    exact = lobe_stiffness(body.meridian, STEEL, supported, 0.002)
    spec = replace(first_spec(body), grading=Grading(0.8, 3.2, 1.0))
    mesh = swept_mesh(body, 180.0 / repeats, spec)
    assert mesh is not None
    solved = lobes(Model.of(mesh, STEEL), supported)
    error = energy_error(solved.mesh, solved.displacement, STEEL).relative
    assert solved.K_energy > exact.lower_Nm_per_rad  # a load stores too little energy: from above
    # such estimates run 1 to 4.4 times low
    assert solved.K_energy == pytest.approx(exact.K_Nm_per_rad, rel=5 * error + 0.002)


@pytest.mark.parametrize("repeats", [1, 2, 3, 4, 5, 6, 9, 12])
@pytest.mark.parametrize("parity", ["even", "odd"])
def test_waves_add_up_to_the_function_on_every_copy(repeats: int, parity: str) -> None:
    orders, sizes = np.array([2, 4, 10, 16]), np.array([1.0, -0.4, 0.3, 0.1])
    turn, sign = (np.cos, 1) if parity == "even" else (np.sin, -1)

    def function(phi: np.ndarray) -> np.ndarray:
        return turn(np.multiply.outer(phi, orders)) @ sizes

    phi = np.linspace(0, pi / repeats, 7)
    for copy in range(2 * repeats):
        reflected = copy % 2
        angle = (copy + reflected) * pi / repeats + (-phi if reflected else phi)
        found = sum(wave.on_copy(wave.of(function, phi), copy) for wave in waves(orders, repeats))
        assert found * sign**reflected == pytest.approx(function(angle), abs=1e-12)
