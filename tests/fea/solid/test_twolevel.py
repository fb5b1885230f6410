"""Iteration against factors on real, elongated meshes; stopping short and memory refused by type."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from dataclasses import replace
from math import sqrt
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import psutil
import pytest
from example_files import EXAMPLES

from flexspline.fea.errors import IterationError, MemoryShortError, SolveError
from flexspline.fea.solid import memory, twolevel
from flexspline.fea.solid.assembly import NodeFrames
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.iteration import conjugate_gradients
from flexspline.fea.solid.load_cases import ellipse, lobes, torsion
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.sizing import Grading
from flexspline.fea.solid.solved import Solved, SolvedStiffness
from flexspline.fea.solid.solver import ITERATION_ENERGY, Case, solve
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.solid.unfold import unfolded
from flexspline.fea.types import Elastic, TetMesh
from flexspline.geometry.load import design_from

STEEL = Elastic(206e3, 0.3)
EXAMPLE = EXAMPLES / "xb1-40.toml"


def cup(far: float, sector: float) -> TetMesh:
    """The six-hole cup, swept: elements up to ten times as long as thick."""
    design = design_from(tomllib.loads(EXAMPLE.read_text(encoding="utf-8")))
    spec = replace(first_spec(design.part("flexspline")), grading=Grading(0.4 * far, far, 1.0))
    mesh = swept_mesh(design.part("flexspline"), 30.0, spec)
    assert mesh is not None
    return unfolded(mesh, sector)


@pytest.fixture(scope="module")
def quarter() -> Model:
    return Model.of(cup(10.0, 90.0), STEEL)


@pytest.fixture(scope="module")
def wedge() -> Model:
    """A third of it, for torsion alone."""
    return Model.of(cup(5.0, 30.0), STEEL)


CASES = {
    "torsion": lambda m: torsion(m, "mesh"),
    "lobes": lambda m: lobes(m, True),
    "lobes, rim free": lambda m: lobes(m, False),
    "ellipse": lambda m: ellipse(m, 0.2),
}


@pytest.mark.parametrize(
    "case", [pytest.param(c, marks=[pytest.mark.long] * (c in ("lobes", "ellipse"))) for c in CASES]
)
def test_iteration_gives_what_factors_give(case: str, quarter: Model, wedge: Model) -> None:
    model = wedge if case == "torsion" else quarter
    direct: Solved = CASES[case](replace(model, solve_by="direct"))
    iterated: Solved = CASES[case](replace(model, solve_by="iterative"))
    assert (direct.solver, iterated.solver) == ("direct", "iterative")
    assert type(iterated) is type(direct)
    if isinstance(iterated, SolvedStiffness) and isinstance(direct, SolvedStiffness):
        assert iterated.K_energy == pytest.approx(direct.K_energy, rel=ITERATION_ENERGY)
        assert iterated.K_check == pytest.approx(direct.K_check, rel=ITERATION_ENERGY)
    apart = np.linalg.norm(iterated.displacement - direct.displacement)
    # energy is quadratic in what is off
    assert apart < sqrt(ITERATION_ENERGY) * np.linalg.norm(direct.displacement)


@pytest.mark.long
def test_a_whole_cup_without_planes_of_symmetry() -> None:
    model = Model.of(cup(6.0, 360.0), STEEL)
    direct = lobes(replace(model, solve_by="direct"), True)
    iterated = lobes(replace(model, solve_by="iterative"), True)
    assert iterated.K_energy == pytest.approx(direct.K_energy, rel=ITERATION_ENERGY)


def test_interpolation_is_exact_for_linear_fields() -> None:
    mesh = cup(4.0, 90.0)
    frames = NodeFrames.cylindrical(mesh.nodes)
    corners = int(mesh.cells[:, :4].max()) + 1
    # middles of straight edges: curved ones lie off the mean of their ends, which is no error here
    straight = mesh.nodes.copy()
    edges = mesh.cells[:, twolevel.EDGES]
    straight[mesh.cells[:, 4:]] = mesh.nodes[edges].mean(axis=2)
    field = straight @ np.array([[1.0, 2.0, -1.0], [0.5, -1.0, 3.0], [2.0, 0.0, 1.0]])
    own = np.einsum("nba,nb->na", frames.axes, field)
    p = twolevel.corner_interpolation(mesh, frames)
    # 40 mm and coefficients below 3: rounding
    assert p @ own[:corners].ravel() == pytest.approx(own.ravel(), abs=1e-11)


def test_steps_do_not_grow_with_the_mesh(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = []

    def spy(*given):
        found = conjugate_gradients(*given)
        if found.steps != twolevel.SPECTRUM_STEPS:
            steps.append(found.steps)
        return found

    monkeypatch.setattr(twolevel, "conjugate_gradients", spy)
    for far in (5.0, 2.5):
        model = Model.of(cup(far, 30.0), STEEL)
        torsion(replace(model, solve_by="iterative"), "mesh")
    # a two-level method's rate is the elements' shape's, not their size's; the shapes differ a little
    assert steps[1] < 1.5 * steps[0]


def test_stopping_short_is_an_error(wedge: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(twolevel, "MOST_STEPS", 5)
    with pytest.raises(IterationError) as caught:
        torsion(replace(wedge, solve_by="iterative"), "mesh")
    assert caught.value.steps == 5
    assert caught.value.left > caught.value.wanted
    assert "5 steps" in str(caught.value)


def test_an_unsupported_body_is_found_by_iteration_too(wedge: Model) -> None:
    load = np.zeros(wedge.matrix.shape[0])
    load[2] = 1.0
    none = np.empty(0, int)
    p = twolevel.corner_interpolation(wedge.mesh, wedge.frames)
    with pytest.raises(SolveError, match="unsupported"):
        solve(wedge.matrix, Case(load, np.empty(0)), none, lambda: p, "iterative")


def test_iteration_without_mkl(wedge: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    with_mkl = torsion(replace(wedge, solve_by="iterative"), "mesh").K_energy
    monkeypatch.setattr("flexspline.fea.solid.direct.pardiso", lambda: None)
    monkeypatch.setattr("flexspline.fea.solid.block_product.mkl", lambda: None)
    without = torsion(replace(wedge, solve_by="iterative"), "mesh").K_energy
    assert without == pytest.approx(with_mkl, rel=1e-8)


def test_refused_beforehand_with_numbers(quarter: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "available_bytes", lambda: 1e6)
    with pytest.raises(MemoryShortError) as caught:
        torsion(quarter, "mesh")
    with pytest.raises(MemoryShortError, match=r"GB of memory and there are 0\.0 GB"):
        Model.of(quarter.mesh, STEEL)
    assert caught.value.unknowns < 3 * len(quarter.mesh.nodes)
    assert caught.value.needed_bytes > caught.value.available_bytes == 1e6


@pytest.mark.parametrize(
    ("unknowns", "there_GB", "corners", "way"),
    [
        (20_000, 16, True, "direct"),
        (60_000, 16, True, "iterative"),
        (1_000_000, 16, True, "iterative"),
        (1_000_000, 64, False, "direct"),  # no interpolation to iterate with
        (150_000, 16, False, "direct"),
        (30_000, 0.1, True, "iterative"),  # factors would be quicker, but do not fit
    ],
)
def test_way_by_unknowns_and_memory(
    unknowns: int, there_GB: float, corners: bool, way: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory, "available_bytes", lambda: there_GB * 2**30)
    monkeypatch.setattr(memory, "pardiso", lambda: object)
    assert memory.choose_solver(unknowns, 80 * unknowns, corners) == way


def test_the_way_without_mkl(monkeypatch: pytest.MonkeyPatch) -> None:
    """A shaft of 41 100 unknowns took 18 s of the processor by factors, 1 s by iteration."""
    monkeypatch.setattr(memory, "available_bytes", lambda: 16 * 2**30)
    monkeypatch.setattr(memory, "pardiso", lambda: None)
    for unknowns, way in ((20_000, "direct"), (41_000, "iterative")):
        for entries in (70, 80):
            assert memory.choose_solver(unknowns, entries * unknowns, True) == way


def test_a_part_that_is_mostly_surface_is_factorised(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "available_bytes", lambda: 16 * 2**30)
    monkeypatch.setattr(memory, "pardiso", lambda: object)
    assert memory.choose_solver(250_000, 70 * 250_000, True) == "direct"
    assert memory.choose_solver(250_000, 80 * 250_000, True) == "iterative"


def test_factors_take_over_from_an_iteration_that_is_slow(
    wedge: Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory, "DIRECT_BELOW", 0)
    monkeypatch.setattr(memory, "THIN_ENTRIES", 0.0)
    steps = []

    def spy(*given):
        found = conjugate_gradients(*given)
        steps.append(found.steps)
        return found

    monkeypatch.setattr(twolevel, "conjugate_gradients", spy)
    monkeypatch.setattr(memory, "STEPS_PER_ROOT", 1.0)
    assert torsion(wedge, "mesh").solver == "iterative"  # √unknowns are some 170 steps
    whole = steps[-1]
    monkeypatch.setattr(memory, "STEPS_PER_ROOT", 0.01)
    found = torsion(wedge, "mesh")
    assert found.solver == "direct"
    # at the first look, for it promises more than three steps
    assert steps[-1] == 10 < whole - 3
    # as far as threads that add in another order agree
    by_factors = torsion(replace(wedge, solve_by="direct"), "mesh")
    assert found.K_energy == pytest.approx(by_factors.K_energy, rel=1e-12)


def test_memory_of_a_container_counts_idle_file_pages_as_free(tmp_path: Path) -> None:
    for name, text in (
        ("memory.max", "8000\n"),
        ("memory.current", "5000\n"),
        ("memory.stat", "anon 3000\ninactive_file 1500\n"),
    ):
        (tmp_path / name).write_text(text, encoding="ascii")
    assert memory.container_free_bytes(tmp_path) == 8000 - 5000 + 1500
    (tmp_path / "memory.max").write_text("max\n", encoding="ascii")
    assert memory.container_free_bytes(tmp_path) == float("inf")


def test_memory_left_is_what_the_machine_can_give_and_not_all_it_has(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """On every system, as psutil counts it; of macOS the whole memory was taken for free before."""
    for limit in ("container_free_bytes", "free_address_space_bytes"):
        monkeypatch.setattr(memory, limit, lambda: float("inf"))
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(available=3, total=8))
    assert memory.available_bytes() == 3

    def unread() -> None:
        raise FileNotFoundError("/proc/meminfo")

    monkeypatch.setattr(psutil, "virtual_memory", unread)
    assert memory.available_bytes() == float("inf")


def test_memory_left_is_bounded_by_the_address_space() -> None:
    code = "import flexspline.fea.solid.memory as m; print(m.available_bytes())"
    command = f"ulimit -v {3 * 2**20}; exec {sys.executable} -c '{code}'"
    said = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=True).stdout
    # 3 GB less what the process holds already
    assert 0 < float(said) < 3 * 2**30


def test_a_million_unknowns_are_expected_to_fit_8_GB(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "available_bytes", lambda: 7 * 2**30)  # imports and mesh have 1
    memory.check_before_assembly(1_000_000)
    with pytest.raises(MemoryShortError):
        memory.check_before_assembly(4_000_000)
