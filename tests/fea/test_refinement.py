"""The loop over finer meshes: when it ends, what it says, and that it keeps what it had."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import inf

import pytest

from flexspline.fea.deadline import NO_DEADLINE, Deadline, OutOfTimeError
from flexspline.fea.refinement import refine, refinements
from flexspline.fea.scaled_estimate import ERROR_RATIOS, MeshResult, ScaledEstimate
from flexspline.fea.types import MeshLevel
from flexspline.geometry.errors import ComputationError

WHY = "the mesher met a wall"


@dataclass(frozen=True)
class Cut:
    """A mesh of so many elements."""

    elements: int


@dataclass
class Halving:
    """An error of 1/elements; each mesh has twice the elements of the one before."""

    tolerance: float
    meshes: float = inf
    fails_at: float = inf
    fault: type[Exception] = ComputationError
    solved: list[int] = field(default_factory=list)

    def solve(self, mesh: Cut) -> None:
        if mesh.elements >= self.fails_at:
            raise self.fault(WHY)
        self.solved.append(mesh.elements)

    @property
    def met(self) -> bool:
        return 1 / self.solved[-1] <= self.tolerance

    def finer(self, mesh: Cut) -> Cut | None:
        return Cut(2 * mesh.elements) if len(self.solved) < self.meshes else None


def test_it_ends_with_the_first_mesh_within_the_tolerance() -> None:
    model = Halving(0.1)
    assert not refine(model, Cut(1))
    assert model.solved == [1, 2, 4, 8, 16]


def test_a_mesh_that_meets_the_tolerance_is_not_too_large() -> None:
    model = Halving(0.1)
    assert not refine(model, Cut(16), most_elements=10)


def test_the_largest_mesh_is_solved_and_the_last() -> None:
    model = Halving(0.0)
    assert (
        "a mesh of more than 4 elements is not refined, and this one has 8"
        in refine(model, Cut(1), most_elements=4).words
    )
    assert model.solved == [1, 2, 4, 8]


def test_no_more_meshes_are_made() -> None:
    model = Halving(0.0, meshes=3)
    assert refine(model, Cut(1)).words.endswith("after 3 meshes")
    assert model.solved == [1, 2, 4]


@pytest.mark.parametrize("fault", [ComputationError, MemoryError])
def test_a_mesh_that_fails_costs_itself_only(fault: type[Exception]) -> None:
    model = Halving(0.0, fails_at=4, fault=fault)
    shortfall = refine(model, Cut(1))
    assert WHY in shortfall.words
    assert shortfall.of_the_machine == (fault is MemoryError)
    assert model.solved == [1, 2]


def test_a_first_mesh_that_fails_is_an_error() -> None:
    with pytest.raises(ComputationError, match=WHY):
        refine(Halving(0.0, fails_at=1), Cut(1))
    with pytest.raises(OutOfTimeError):
        refine(Halving(0.0), Cut(1), Deadline(0.0))


def test_a_bug_is_no_shortfall() -> None:
    with pytest.raises(ZeroDivisionError):
        refine(Halving(0.0, fails_at=2, fault=ZeroDivisionError), Cut(1))


def test_what_was_found_can_be_seen_after_each_mesh() -> None:
    model = Halving(0.0, fails_at=8)
    seen = [
        (len(model.solved), bool(said)) for said in refinements(model, Cut(1), NO_DEADLINE, inf)
    ]
    assert seen == [(1, False), (2, False), (3, False), (3, True)]


def mesh_of(K: float, error: float) -> MeshResult:
    return MeshResult(MeshLevel(shortest_edge_mm=1.0, elements=1, dofs=1, K_Nm_per_rad=K), error)


def test_two_meshes_give_the_scale_of_an_estimate() -> None:
    """K = 100; upper bounds 10 and 4 too large, of which the estimate sees 40 %: c = 2.5."""
    found = ScaledEstimate(usual=2.0, believed=(1.5, 3.1))
    found = found.with_mesh(mesh_of(110.0, 4.0 / 110.0))
    assert (found.scale, found.relative) == (2.0, 2.0 * 4.0 / 110.0)
    found = found.with_mesh(mesh_of(104.0, 1.6 / 104.0))
    assert found.scale == pytest.approx(2.5, rel=1e-12)
    bounds = found.at_given_angle()
    assert bounds == pytest.approx((100.0, 96.0, 104.0), rel=1e-12)


def test_at_a_given_torque_the_estimate_is_added_to_the_angle() -> None:
    """1/K = 0.0100; meshes 10 and 4 % too stiff by their energy, a hundredth of it left out besides."""
    found = ScaledEstimate(usual=2.0, believed=(1.5, 3.1))
    found = found.with_mesh(mesh_of(1 / 0.0090, 0.0004 / 0.0090))
    found = found.with_mesh(mesh_of(1 / 0.0096, 0.00016 / 0.0096))
    assert 1 / found.at_given_torque().upper == pytest.approx(0.0096)
    error = found.relative
    assert [1 / K for K in found.at_given_torque()] == pytest.approx(
        [0.0096 * (1 + error), 0.0096 * (1 + 2 * error), 0.0096], rel=1e-12
    )
    assert 1 / found.at_given_torque(0.01).lower == pytest.approx(
        0.0096 * (1.01 + 2 * error), rel=1e-12
    )


@pytest.mark.parametrize(
    ("K", "estimate", "expected"), [(60.0, 1.0, 3.1), (109.9, 1.0, 1.5), (104.0, 5.0, 3.1)]
)
def test_a_scale_beyond_belief_is_not_taken(K: float, estimate: float, expected: float) -> None:
    """Too large, too small, and an estimate that rose, which says nothing: the careful end."""
    found = ScaledEstimate(usual=2.0, believed=(1.5, 3.1))
    found = found.with_mesh(mesh_of(110.0, 4.0 / 110.0))
    found = found.with_mesh(mesh_of(K, estimate / K))
    assert found.scale == expected


def test_what_no_mesh_takes_away_is_added_to_both_ends() -> None:
    """Of the last mesh: K₀ and its field are solved better for each."""
    found = ScaledEstimate(usual=2.0, believed=(1.5, 3.1))
    found = found.with_mesh(replace(mesh_of(90.0, 0.01), doubt=0.5))
    found = found.with_mesh(replace(mesh_of(90.0, 0.01), doubt=0.02))
    none = ScaledEstimate(usual=2.0, believed=(1.5, 3.1))
    for _ in range(2):
        none = none.with_mesh(mesh_of(90.0, 0.01))
    assert found.K_Nm_per_rad == 90.0
    with_it, without = found.at_given_angle(), none.at_given_angle()
    assert with_it.K == without.K
    assert without.lower - with_it.lower == pytest.approx(0.02 * 90.0)
    assert with_it.upper - without.upper == pytest.approx(0.02 * 90.0)
    assert with_it.half == pytest.approx((with_it.upper - with_it.lower) / 2 / with_it.K)
    with_it, without = found.at_given_torque(), none.at_given_torque()
    assert with_it.K == without.K
    assert 1 / with_it.lower - 1 / without.lower == pytest.approx(0.02 / 90.0)
    assert 1 / without.upper - 1 / with_it.upper == pytest.approx(0.02 / 90.0)


@pytest.mark.parametrize("q", [0.5, 0.7, 0.85])
def test_an_estimate_that_does_not_see_the_error_is_left_for_the_falls_of_K(q: float) -> None:
    """K falls by q each time and the estimate hardly at all, as on a shaft whose sharp edges took every
    element: from the third mesh on the bounds, K less twice its error to K, hold the limit."""
    limit, first = 5140.0, 60.0
    found = ScaledEstimate(usual=2.0, believed=(2.5, 4.2), falls=ERROR_RATIOS)
    for n in range(5):
        found = found.with_mesh(mesh_of(limit + first * q**n, 0.0002 * 0.95**n))
        if n >= 2:
            assert found.K_Nm_per_rad * (1 - 2 * found.relative) <= limit
    alone = ScaledEstimate(2.0, (2.5, 4.2), found.meshes)
    # what the estimate alone would claim is less than what K has still to fall where it falls slowly
    assert (alone.K_Nm_per_rad * (1 - 2 * alone.relative) > limit) is (q > 0.5)
