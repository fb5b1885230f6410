"""Sobol indices and tightening, on functions whose answers are known."""

from pathlib import Path

import numpy as np
import pytest
from known_indices import additive, ishigami, uniform
from study_bench import LENGTH, WALL, study_of, threads

from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome, Task
from flexspline.pipeline.study.figures import TOTAL
from flexspline.pipeline.study.indices import sampled_indices
from flexspline.pipeline.study.run import run_study, source_of, trial_store_of
from flexspline.pipeline.study.scatter import Scatter, scatter_of
from flexspline.pipeline.study.study import StudyError
from flexspline.pipeline.study.tolerance import ScatteredInput, saltelli
from flexspline.results.report.payload import payload_of
from flexspline.results.study.record import summary, words
from flexspline.results.study.report import study_document

DIAPHRAGM = "flexspline.diaphragm_thickness_mm"
MODULUS = "material.flexspline.youngs_modulus_GPa"
STUDY = f"""
design = "xb1-40.toml"
[tolerance]
"{WALL}" = {{ plus_minus = 0.02 }}
"{LENGTH}" = {{ plus_minus = 0.2 }}
"{DIAPHRAGM}" = {{ std = 0.01 }}
[run]
method = "tolerance"
"""


def test_a_known_function_through_a_whole_study(tmp_path: Path) -> None:
    """x + y² + xz of numbers uniform over ± 1: V1 = 1/3, V2 = 4/45, V13 = 1/9."""
    study = study_of(STUDY.replace("std = 0.01", "plus_minus = 0.02") + "evaluations = 64\n")
    inputs = {x.key: x for x in source_of(study).inputs}

    def evaluation(task: Task) -> Outcome:
        """The three dimensions stretched over ± 1; what else scatters has no part in it."""
        own = [inputs[k] for k in (WALL, LENGTH, DIAPHRAGM)]
        x, y, z = ((task.values[i.key] - i.nominal) / (i.high - i.nominal) for i in own)
        return Outcome({TOTAL: x + y**2 + x * z})

    result = run_study(study, trial_store_of(study, tmp_path), threads, evaluation)
    (scatter,) = result.scatter
    found = scatter.indices
    assert found is not None
    assert "follows no single dimension" not in str(payload_of(study_document(result, ())))
    at = {x.key: i for i, x in enumerate(scatter.inputs)}
    v = np.array([1 / 3, 4 / 45, 1 / 9])
    for key, first, total in (
        (WALL, v[0], v[0] + v[2]), (LENGTH, v[1], v[1]), (DIAPHRAGM, 0.0, v[2]),
    ):  # fmt: skip
        assert found.first[at.pop(key)] == pytest.approx(first / v.sum(), abs=1e-6)
        assert found.total[list(inputs).index(key)] == pytest.approx(total / v.sum(), abs=1e-6)
    assert np.abs(found.total[list(at.values())]).max() < 1e-6


def scattered(
    inputs: tuple[ScatteredInput, ...], base: int, values: np.ndarray, seed: int = 1
) -> Scatter:
    """A whole study's scatter, from values at the points of `saltelli`."""
    keys = [x.key for x in inputs]
    rows = tuple(
        Row(
            i,
            dict(zip(keys, map(float, p), strict=True)),
            Outcome({TOTAL: float(v)} if v == v else {}),
        )
        for i, (p, v) in enumerate(zip(saltelli(inputs, base, seed), values, strict=True))
    )
    return scatter_of(TOTAL, inputs, rows, seed)


def test_tightening_a_sum_of_normals_buys_what_the_root_of_squares_says() -> None:
    std = np.array([3.0, 2.0, 1.0])
    inputs = additive().inputs[:3]
    scatter = scattered(inputs, 256, saltelli(inputs, 256, 1).sum(axis=1))
    assert scatter.surface is not None
    assert scatter.surface.misfit < 1e-18  # a plane lies on the surface
    for row in scatter.tightened:
        now = std.copy()
        now["abc".index(row.key)] *= row.factor
        # 8192 random points would know each end to 0.03 σ, 1 % of the width
        assert row.width == pytest.approx(2 * 1.95996 * np.hypot.reduce(now), rel=0.01)


@pytest.mark.parametrize("base", [8, pytest.param(64, marks=pytest.mark.long)])
def test_tightening_and_indices_tell_one_story(base: int) -> None:
    """Additive: first order is total, they share out all, and who has more of it buys more."""
    rng = np.random.default_rng(base)
    for _ in range(3):
        std = 1.3 ** rng.permutation(5) * rng.uniform(1.0, 1.1, 5)
        inputs = tuple(
            ScatteredInput(k, 0.0, s, -4 * s, 4 * s, True)
            for k, s in zip("abcde", std, strict=True)
        )
        found = scattered(inputs, base, saltelli(inputs, base, 1) @ np.array([1, -1, 1, 1, -1]))
        assert found.indices is not None
        assert found.indices.first.sum() == pytest.approx(1, abs=1e-6)
        assert found.indices.total.sum() == pytest.approx(1, abs=1e-6)
        perfect = {t.key: t.bought for t in found.tightened if t.factor == 0.0}
        by_tightening = sorted(range(5), key=lambda i: -perfect["abcde"[i]])
        assert tuple(by_tightening) == found.order == tuple(np.argsort(-std))


@pytest.mark.parametrize("base", [8, 32])
def test_a_gear_s_modulus_is_seen_by_few_evaluations(base: int) -> None:
    """A wind-up over E, walls to the third power: indices from 2²⁰ points beside those of a small study."""
    inputs = (
        ScatteredInput("E", 206.0, 4.12, 190.0, 222.0, True), uniform("wall", 0.02, 0.4),
        uniform("diaphragm", 0.03, 0.6), uniform("length", 0.2, 30.0),
        ScatteredInput("j", 3.0, 0.3, 2, 4, True),
    )  # fmt: skip

    def windup(x: np.ndarray) -> np.ndarray:
        E, wall, diaphragm, length, j = x.T
        return 4e4 / E * (0.4 / wall + 0.1 * (0.6 / diaphragm) ** 3) * (length / 30) + 4 * j

    large = saltelli(inputs, 2**17, 3)
    truth, _ = sampled_indices(windup(large).reshape(2**17, -1))
    found = scattered(inputs, base, windup(saltelli(inputs, base, 1)))
    assert found.indices is not None
    # the reference is known to 0.005
    assert found.indices.first == pytest.approx(truth.first, abs=0.01)
    assert found.indices.total == pytest.approx(truth.total, abs=0.01)
    assert found.std == pytest.approx(float(windup(large).std()), rel=0.02)


def test_where_too_little_is_known_there_is_no_index_and_enough_would_do() -> None:
    case = ishigami()

    def found(base: int, seed: int) -> Scatter:
        points = saltelli(case.inputs, base, seed)
        return scattered(case.inputs, base, case.function(points), seed)

    few = found(64, 1)
    assert few.indices is None
    assert few.tightened == ()
    assert few.shares is not None
    assert few.shares.enough is not None
    enough = few.shares.enough // (len(case.inputs) + 2)
    assert 64 < enough <= 16384
    told = [found(enough, seed).indices is not None for seed in range(10)]
    assert sum(told) >= 8  # "about": a prediction from 64 blocks


def test_a_figure_that_no_input_moves_has_no_indices() -> None:
    inputs = additive().inputs
    found = scattered(inputs, 8, np.full(48, 7.0))
    assert found.indices is None
    assert (found.low, found.mean, found.high) == (7.0, 7.0, 7.0)


def test_designs_that_cannot_be_built_cost_the_surface_nothing_else() -> None:
    inputs = additive().inputs
    values = saltelli(inputs, 16, 1).sum(axis=1)
    values[[3, 40, 41]] = np.nan
    found = scattered(inputs, 16, values)
    assert found.dropped == 3
    assert found.indices is not None
    assert found.indices.total == pytest.approx(additive().total, abs=0.005)


def test_the_scatter_of_the_design_s_own_uncertainty_is_its_standard_deviation(
    tmp_path: Path,
) -> None:
    study = study_of(
        'design = "xb1-40.toml"\n[run]\nmethod = "tolerance"\nevaluations = 320\n'
    )  # fmt: skip
    result = run_study(study, trial_store_of(study, tmp_path), threads)
    (scatter,) = result.scatter
    stated = np.median([r.outcome.figures["backlash_arcsec.std"] for r in result.rows])
    # 128 independent designs know a standard deviation to 1/√(2·128) = 6 %, a Sobol sequence better
    assert scatter.std == pytest.approx(float(stated), rel=0.06)
    assert scatter.low < scatter.mean < scatter.high


def test_a_study_whose_designs_all_fail_keeps_its_rows(tmp_path: Path) -> None:
    study = study_of(STUDY + "evaluations = 64\n")

    def evaluation(task: Task) -> Outcome:
        return Outcome(faults=("nothing could be built",))

    result = run_study(study, trial_store_of(study, tmp_path), threads, evaluation)
    assert [r.outcome.reason for r in result.rows] == ["nothing could be built"] * 64
    assert result.scatter == ()
    assert "only 0 of" in result.unscattered
    assert result.unscattered in words(result, {**summary(result), "files": []})
    text = str(payload_of(study_document(result, ())))
    assert result.unscattered in text
    assert "follows no single dimension" not in text
    assert "design 0: nothing could be built" in text


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("plus_minus = 0.02", "plus_minus = 0.5", "too wide"),
        ("plus_minus = 0.02", "plus_minus = 0.02, std = 0.1", "plus_minus = … } or { std"),
        ("[run]", "[run]\nevaluations = 10", "must be at least 64"),
        ("[tolerance]", "[vary]", "unknown key"),
        ("[run]", f'[link]\n"{WALL}" = {{ of = "{LENGTH}" }}\n[run]', "keep one"),
        ("[run]", f'[link]\n"{MODULUS}" = {{ of = "{LENGTH}" }}\n[run]', "keep one"),
    ],
)
def test_a_wrong_tolerance_is_refused(old: str, new: str, said: str) -> None:
    with pytest.raises(StudyError) as caught:
        source_of(study_of(STUDY.replace(old, new, 1)))
    assert said in str(caught.value)


def test_a_shaft_of_its_own_modulus_scatters_by_its_own_tolerance() -> None:
    """The flexspline's ratio, by the design's [uncertainty], is not put over it."""
    shaft = "material.shaft.youngs_modulus_GPa"
    text = STUDY.replace("[run]", f'"{shaft}" = {{ plus_minus = 10.0 }}\n[run]', 1)
    text = text.replace("xb1-40.toml", "keyed-shaft.toml")
    source = source_of(study_of(text))
    values = {WALL: 0.4, LENGTH: 30.0, DIAPHRAGM: 0.6, MODULUS: 190.0, shaft: 203.0}
    assert source.task(values).values[shaft] == 203.0
