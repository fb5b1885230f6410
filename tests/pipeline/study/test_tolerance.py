"""Sobol indices and tightening, on functions whose answers are known."""

from pathlib import Path

import numpy as np
import pytest
from study_bench import LENGTH, WALL, study_of, threads

from pipeline.study.evaluate import Outcome, Task
from pipeline.study.load import StudyError
from pipeline.study.run import ledger_of, run_study, source_of
from pipeline.study.scatter import sobol_indices, tightening
from pipeline.study.tolerance import Input, saltelli

DIAPHRAGM = "flexspline.diaphragm_thickness_mm"
STUDY = f"""
design = "xb1-40.toml"
[tolerance]
"{WALL}" = {{ plus_minus = 0.02 }}
"{LENGTH}" = {{ plus_minus = 0.2 }}
"{DIAPHRAGM}" = {{ std = 0.01 }}
[run]
method = "tolerance"
"""


def ishigami(x: np.ndarray) -> np.ndarray:
    """Ishigami and Homma, First Int. Symp. Uncertainty Modeling (1990) 398-403: a = 7, b = 0.1."""
    return np.sin(x[..., 0]) + 7 * np.sin(x[..., 1]) ** 2 + 0.1 * x[..., 2] ** 4 * np.sin(x[..., 0])


# closed forms: V1 = (1 + bπ⁴/5)²/2, V2 = a²/8, V13 = b²π⁸(1/18 − 1/50), V the sum
_V1, _V2, _V13 = (1 + 0.1 * np.pi**4 / 5) ** 2 / 2, 49 / 8, 0.01 * np.pi**8 * (1 / 18 - 1 / 50)
_V = _V1 + _V2 + _V13
FIRST = np.array([_V1, _V2, 0.0]) / _V
TOTAL = np.array([_V1 + _V13, _V2, _V13]) / _V


def uniform(key: str, half: float) -> Input:
    return Input(key, 0.0, half / 3**0.5, -half, half, False)


def test_ishigami_through_samples_and_indices() -> None:
    inputs = tuple(uniform(k, np.pi) for k in "abc")
    found = sobol_indices(inputs, ishigami(saltelli(inputs, 1024, 1)), 1)
    assert found.first == pytest.approx(FIRST, abs=float(found.first_conf.max()))
    assert found.total == pytest.approx(TOTAL, abs=float(found.total_conf.max()))
    assert found.first_conf.max() < 0.15  # or the two lines above would say nothing
    assert found.total_conf.max() < 0.15


def test_ishigami_through_a_whole_study(tmp_path: Path) -> None:
    text = STUDY.replace("std = 0.01", "plus_minus = 0.02") + "evaluations = 512\n"
    study = study_of(text)
    source = source_of(study)
    nominal = {x.key: x.nominal for x in source.inputs}
    half = {x.key: x.high - x.nominal for x in source.inputs}

    def evaluation(task: Task) -> Outcome:
        """The three dimensions stretched over ±π; what else scatters has no part in it."""
        keys = (WALL, LENGTH, DIAPHRAGM)
        x = np.array([np.pi * (task.values[k] - nominal[k]) / half[k] for k in keys])
        return Outcome({"backlash_arcsec.total": float(ishigami(x))})

    result = run_study(study, ledger_of(study, tmp_path), threads, lambda p: None, evaluation)
    (scatter,) = result.scatter
    at = [next(i for i, x in enumerate(scatter.inputs) if x.key == k) for k in nominal]
    order = {k: i for k, i in zip(nominal, at, strict=True)}
    found = scatter.indices
    for i, key in enumerate((WALL, LENGTH, DIAPHRAGM)):
        j = order[key]
        # twice the 95 % half-width: six comparisons, of which one in twenty may miss the single one
        assert found.first[j] == pytest.approx(FIRST[i], abs=2 * found.first_conf[j] + 1e-3)
        assert found.total[j] == pytest.approx(TOTAL[i], abs=2 * found.total_conf[j] + 1e-3)
    silent = [i for i, x in enumerate(scatter.inputs) if x.key not in (WALL, LENGTH, DIAPHRAGM)]
    assert np.abs(found.total[silent]).max() == 0


def test_tightening_a_sum_of_normals_buys_what_the_root_of_squares_says() -> None:
    std = np.array([3.0, 2.0, 1.0])
    inputs = tuple(Input(k, 0.0, s, -4 * s, 4 * s, True) for k, s in zip("abc", std, strict=True))
    points = saltelli(inputs, 256, 1)
    table, rms = tightening(inputs, points, points.sum(axis=1), 1)
    assert rms < 1e-9  # a plane lies on the surface
    for row in table:
        now = std.copy()
        now["abc".index(row.key)] *= row.factor
        # 8192 random points would know each end to 0.03 σ, 1 % of the width
        assert row.width == pytest.approx(2 * 1.95996 * np.hypot.reduce(now), rel=0.01)


def test_the_scatter_of_the_design_s_own_uncertainty_is_its_standard_deviation(
    tmp_path: Path,
) -> None:
    study = study_of(
        'design = "xb1-40.toml"\n[run]\nmethod = "tolerance"\nevaluations = 320\n'
    )  # fmt: skip
    result = run_study(study, ledger_of(study, tmp_path), threads, lambda p: None)
    (scatter,) = result.scatter
    stated = np.median([r.outcome.figures["backlash_arcsec.std"] for r in result.rows])
    # 128 independent designs know a standard deviation to 1/√(2·128) = 6 %, a Sobol sequence better
    assert scatter.std == pytest.approx(float(stated), rel=0.06)
    assert scatter.low < scatter.mean < scatter.high


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("plus_minus = 0.02", "plus_minus = 0.5", "too wide"),
        ("plus_minus = 0.02", "plus_minus = 0.02, std = 0.1", "plus_minus = … } or { std"),
        ("[run]", "[run]\nevaluations = 10", "must be at least 64"),
        ("[tolerance]", "[vary]", "unknown key"),
    ],
)
def test_a_wrong_tolerance_is_refused(old: str, new: str, said: str) -> None:
    with pytest.raises(StudyError) as caught:
        source_of(study_of(STUDY.replace(old, new, 1)))
    assert said in str(caught.value)
