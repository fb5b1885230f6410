"""What moves a study's figures, and which ends of spans a better design may lie beyond."""

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
import pytest
from example_files import EXAMPLES
from scipy.stats import spearmanr

from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome
from flexspline.pipeline.study.influence import (
    OpenEnd,
    binding,
    open_ends,
    own_influences,
    unbuilt_neighbours,
)
from flexspline.pipeline.study.load import study_from
from flexspline.pipeline.study.result import StudyResult

WALL, LENGTH = "flexspline.wall_thickness_mm", "flexspline.length_mm"
K, STRESS = "K_b_Nm_per_rad", "wave_generator_peak_mises_MPa"
STUDY = f"""
design = "xb1-40.toml"
[vary]
"{WALL}" = {{ min = 0.3, max = 0.5 }}
"{LENGTH}" = {{ min = 20.0, max = 30.0 }}
[objective]
"{K}" = "maximize"
[constraint]
"{STRESS}" = {{ max = 400.0 }}
[run]
method = "sobol"
"""


def result_of(
    designs: Iterable[tuple[float, float, float, float]],
    one: Mapping[str, float] | None = None,
    failed: tuple[float, ...] = (),
) -> StudyResult:
    """Wall, length, stiffness and stress of each design; `one`: keys with one value each, or one that was
    built beside those that `failed`."""
    only = {key: {"values": [value, *failed]} for key, value in (one or {}).items()}
    tables = tomllib.loads(STUDY)
    study = study_from(tables | {"vary": tables["vary"] | only}, EXAMPLES, "test")
    rows = (
        Row(i, {WALL: wall, LENGTH: length, **(one or {})}, Outcome({K: stiffness, STRESS: stress}))
        for i, (wall, length, stiffness, stress) in enumerate(designs)
    )
    return StudyResult(study, tuple(rows))


DIAPHRAGM, RING = "flexspline.diaphragm_thickness_mm", "flexspline.ring_thickness_mm"


@pytest.mark.parametrize(
    ("count", "one", "failed"),
    [
        (10, {}, ()),
        (10, {DIAPHRAGM: 0.6}, ()),
        (10, {DIAPHRAGM: 0.6, RING: 0.55}, ()),
        (12, {DIAPHRAGM: 0.6}, ()),
        (12, {DIAPHRAGM: 0.6}, (0.1, 9.0)),
    ],
)
def test_an_end_is_open_only_where_the_objective_gains_towards_it(
    count: int, one: dict[str, float], failed: tuple[float, ...]
) -> None:
    """The stiffness gains with the wall and falls with the length, at whose end the best happens to lie.

    A key of one value says nothing, hides nothing, and asks for no design more.
    """
    last = count - 1
    places = [(i / last, (7 * i % count) / last) for i in range(count)]
    places[-1] = (1.0, 1.0)
    result = result_of(
        ((0.3 + 0.2 * w, 20 + 10 * x, 3e4 + 100 * w - 8 * x, 300.0) for w, x in places), one, failed
    )
    (best,) = result.pareto
    assert best.slot == last
    assert open_ends(result, best) == (OpenEnd(WALL, 0.5, "upper"),)


@pytest.mark.parametrize(
    ("stresses", "held"),
    [
        ((300.0, 395.0, 410.0), (STRESS,)),
        ((300.0, 395.0), ()),  # nothing better was built that the limit forbids
        ((300.0, 350.0, 410.0), ()),  # far from the limit
    ],
)
def test_a_constraint_binds_a_design_at_its_limit_beyond_which_a_better_one_is(
    stresses: tuple[float, ...], held: tuple[str, ...]
) -> None:
    result = result_of((0.3, 20.0, 3e4 + s, s) for s in stresses)
    assert binding(result, result.pareto[0]) == held


GRID = f"""
design = "xb1-40.toml"
[vary]
"{WALL}" = {{ values = [0.3, 0.4, 0.6, 0.9] }}
"{LENGTH}" = {{ values = [20.0, 25.0, 30.0] }}
[objective]
"{K}" = "maximize"
[run]
method = "grid"
"""


def grid_of(stiffness: Mapping[tuple[float, float], float]) -> StudyResult:
    """Every combination of wall and length; those without a stiffness were not built."""
    places = [(w, x) for w in (0.3, 0.4, 0.6, 0.9) for x in (20.0, 25.0, 30.0)]
    rows = (
        Row(
            i,
            {WALL: at[0], LENGTH: at[1]},
            Outcome({K: stiffness[at]}) if at in stiffness else Outcome(faults=("not built",)),
        )
        for i, at in enumerate(places)
    )
    return StudyResult(study_from(tomllib.loads(GRID), EXAMPLES, "test"), tuple(rows))


def test_an_end_that_alone_could_be_built_is_not_open() -> None:
    """Length 30 mm alone was built; next to the best wall of 0.4 mm, 0.6 mm was not, but 0.9 mm was."""
    result = grid_of({(0.3, 30.0): 1e4, (0.4, 30.0): 3e4, (0.9, 30.0): 2e4})
    (best,) = result.pareto
    assert open_ends(result, best) == ()
    assert unbuilt_neighbours(result, best) == ((WALL, 0.6), (LENGTH, 25.0))


@pytest.mark.parametrize(
    ("shorter", "found", "unbuilt"),
    [(2e4, (OpenEnd(LENGTH, 30.0, "upper"),), ()), (None, (), ((LENGTH, 25.0),))],
)
def test_few_designs_of_a_grid_show_an_end_by_their_neighbour(
    shorter: float | None, found: tuple[OpenEnd, ...], unbuilt: tuple[tuple[str, float], ...]
) -> None:
    """A softer neighbour inward shows a gain towards the end; one that is not there shows nothing."""
    inward = {} if shorter is None else {(0.4, 25.0): shorter}
    result = grid_of(
        {(0.3, 30.0): 1e4, (0.4, 30.0): 3e4, (0.6, 30.0): 2e4, (0.3, 25.0): 2e4} | inward
    )
    (best,) = result.pareto
    assert open_ends(result, best) == found
    assert unbuilt_neighbours(result, best) == unbuilt


def test_a_neighbour_that_would_be_worse_is_not_missed() -> None:
    """A thicker wall could not be built, but a thinner one is better and breaks the constraint."""
    result = grid_of({(0.3, 30.0): 4e4, (0.4, 30.0): 3e4})
    tables = tomllib.loads(GRID) | {"constraint": {K: {"max": 3.5e4}}}
    result = replace(result, study=study_from(tables, EXAMPLES, "test"))
    (best,) = result.pareto
    assert best.values[WALL] == 0.4
    assert unbuilt_neighbours(result, best) == ((LENGTH, 25.0),)


def test_what_only_goes_along_is_no_influence() -> None:
    """The stiffness follows the length alone; an optimiser moved the wall with it, rank correlation 0.7."""
    rng = np.random.default_rng(20261124)
    along, own, scatter = rng.random((3, 30))
    designs = zip(
        0.3 + 0.1 * (along + own), 20 + 10 * along, 3e4 - 1e3 * along + 50 * scatter, [300.0] * 30,
        strict=True,
    )  # fmt: skip
    (found,) = own_influences(result_of(designs))[K]
    assert spearmanr(along + own, -along).statistic < -0.5
    assert found.key == LENGTH
    assert found.correlation < 0


def test_ranks_count_and_equal_values_share_theirs() -> None:
    """Spearman's correlation as scipy has it, of a cubic with pairs of equal values."""
    walls, cubes = [0.3 + 0.04 * (i // 2) for i in range(10)], [(i - 3.0) ** 3 for i in range(10)]
    result = result_of((w, 25.0, 3e4 + c, 300.0) for w, c in zip(walls, cubes, strict=True))
    (found,) = own_influences(result)[K]
    assert found.key == WALL
    assert found.correlation == pytest.approx(spearmanr(walls, cubes).statistic, abs=1e-12)
