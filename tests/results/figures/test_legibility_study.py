"""Study figures: no words on words, no legend over bars, walls thick enough to be seen."""

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from example_files import EXAMPLES
from legibility import drawn_figures, faults

from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome
from flexspline.pipeline.study.figures import TOTAL
from flexspline.pipeline.study.load import study_from
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.scatter import scatter_of
from flexspline.pipeline.study.tolerance import ScatteredInput, saltelli
from flexspline.results.study.best_figure import best_figure
from flexspline.results.study.figures import (
    write_convergence,
    write_figures,
    write_parallel,
    write_pareto,
)
from flexspline.results.study.sweep_figure import write_sweep
from flexspline.results.study.tolerance_figure import write_scatter

WALL, LENGTH = "flexspline.wall_thickness_mm", "flexspline.length_mm"
K, STRESS = "K_b_Nm_per_rad", "wave_generator_peak_mises_MPa"
KEYS = (
    "material.flexspline.youngs_modulus_GPa", "gear.flank_clearance_um", WALL,
    "bearing.radial_clearance_um", "flexspline.diaphragm_thickness_mm", LENGTH,
)  # fmt: skip


def result_of(name: str, wall_mm: float, length_mm: float) -> StudyResult:
    study = study_from(
        tomllib.loads(
            f'design = "{name}.toml"\n[vary]\n"{WALL}" = {{ min = 0.1, max = 0.6 }}\n'
            f'"{LENGTH}" = {{ min = 10, max = 60 }}\n'
            f'[objective]\n"{K}" = "maximize"\n"{STRESS}" = "minimize"\n[run]\nmethod = "optimize"\n'
        ),
        EXAMPLES, "test",
    )  # fmt: skip
    shares = [(0.75, 0.85), (1.0, 1.1), (1.25, 1.0), (0.9, 0.95)]
    rows = tuple(
        Row(
            i,
            {WALL: wall_mm * a, LENGTH: length_mm * b},
            Outcome({K: 3e4 * a, STRESS: 300.0 * a * b}),
        )
        for i, (a, b) in enumerate(shares)
    )
    return StudyResult(study, rows)


@pytest.mark.parametrize(
    ("name", "wall_mm", "length_mm"), [("xb1-40", 0.4, 30), ("hat-25", 0.45, 28)]
)
def test_walls_of_the_best_can_be_seen(name: str, wall_mm: float, length_mm: float) -> None:
    figure = best_figure(result_of(name, wall_mm, length_mm))
    assert faults(figure) == []
    for section, *details in zip(*[iter(figure.axes)] * 3, strict=True):
        for axes in (section, *details):
            box = axes.get_window_extent()
            scales = box.width / np.ptp(axes.get_xlim()), box.height / np.ptp(axes.get_ylim())
            assert scales[0] == pytest.approx(scales[1], rel=1e-6)  # in proportion
            if axes is not section:  # a tenth of an inch: the thinnest wall is ten lines wide
                assert scales[0] * 0.75 * wall_mm / figure.dpi > 0.1


@pytest.mark.parametrize("draw", [write_pareto, write_parallel, write_convergence])
def test_charts_of_designs_can_be_read(draw, tmp_path: Path) -> None:
    with drawn_figures() as figures:
        draw(tmp_path / "chart.png", result_of("xb1-40", 0.4, 30))
    assert [faults(f) for f in figures] == [[]]


HALF_SEAT, MASS = "wave_generator_peak_half_seat_mises_MPa", "flexspline_mass_g"
LENGTH_OF_PART, SHAFT_MASS = "flexspline_length_mm", "shaft_mass_g"


def swept(method: str = "grid", more: str = "") -> StudyResult:
    """Of one dimension: six designs, the third not built, the last two at the excluded border."""
    study = study_from(
        tomllib.loads(
            f'design = "xb1-40.toml"\n[vary]\n"{WALL}" = {{ min = 0.3, max = 0.5 }}\n{more}'
            f'[objective]\n"{K}" = "maximize"\n[constraint]\n"{STRESS}" = {{ max = 430.0 }}\n'
            f'"{HALF_SEAT}" = {{ max = 500.0 }}\n"{MASS}" = {{ max = 500.0 }}\n'
            f'[run]\nmethod = "{method}"\nevaluations = 6\n'
        ),
        EXAMPLES, "test",
    )  # fmt: skip
    walls = (0.5, 0.3, 0.34, 0.38, 0.42, 0.46)  # not in their order, as a search has them
    rows = tuple(
        Row(
            i,
            {WALL: wall, **({LENGTH: 30.0} if more else {})},
            Outcome(
                {
                    K: 1e5 * wall, STRESS: 500.0 - 200 * wall, HALF_SEAT: 300.0 + 400 * wall,
                    MASS: 60.0 + wall, "wave_generator_peak_at_excluded_border": float(wall > 0.45),
                }
            ) if i != 3 else Outcome({}, ("no mesh",)),
        )
        for i, wall in enumerate(walls)
    )  # fmt: skip
    return StudyResult(study, rows)


def test_a_sweep_s_curves_can_be_read(tmp_path: Path) -> None:
    with drawn_figures() as figures:
        write_sweep(tmp_path / "sweep.png", swept())
    assert [faults(f) for f in figures] == [[]]


def test_a_sweep_says_how_many_figures_it_leaves_out(tmp_path: Path) -> None:
    result = swept()
    more = {LENGTH_OF_PART: 30.0, SHAFT_MASS: 80.0}
    objective = {K: "maximize", **dict.fromkeys(more, "minimize")}
    file = result.study.file.model_copy(update={"objective": objective})
    rows = [
        replace(r, outcome=replace(r.outcome, figures=r.outcome.figures | more))
        for r in result.rows
        if r.outcome.figures
    ]
    result = replace(result, study=replace(result.study, file=file), rows=tuple(rows))
    with drawn_figures() as figures:
        write_sweep(tmp_path / "sweep.png", result)
    assert [faults(f) for f in figures] == [[]]
    assert figures[0].axes[-1].get_xlabel().endswith("\n2 more figures in study.csv")


def test_parallel_lines_say_how_many_dimensions_they_leave_out(tmp_path: Path) -> None:
    result = result_of("xb1-40", 0.4, 30)
    many = {f"shaft.segment[{k}].length_mm": 4.0 for k in range(7)}
    rows = tuple(replace(r, values=r.values | many) for r in result.rows)
    with drawn_figures() as figures:
        write_parallel(tmp_path / "parallel.png", replace(result, rows=rows))
    assert [faults(f) for f in figures] == [[]]
    (head,) = (t.get_text() for t in figures[0].texts)
    assert head.endswith("; 2 more dimensions in study.csv")


def test_of_one_dimension_each_figure_is_a_curve_with_its_limit_and_the_best(
    tmp_path: Path,
) -> None:
    with drawn_figures() as figures:
        write_sweep(tmp_path / "sweep.png", swept())
    stiffness, stress, half, mass = figures[0].axes
    curve = stiffness.lines[0]
    assert list(curve.get_xdata()) == [0.3, 0.34, 0.38, 0.42, 0.46, 0.5]
    gap = np.isnan(curve.get_ydata())  # where a design could not be built
    assert list(gap) == [False, False, True, False, False, False]
    marks = {line.get_label(): line for line in stress.lines}
    assert list(marks["limit"].get_ydata()) == [430.0, 430.0]
    assert list(marks["at excluded border"].get_xdata()) == [0.46, 0.5]
    assert list(marks["not allowed"].get_xdata()) == [0.3, 0.34]
    for axes in (stiffness, stress, half, mass):  # 0.5 mm is the stiffest of those allowed
        (best,) = [line for line in axes.lines if line.get_label() == "best"]
        assert list(best.get_xdata()) == [0.5]
    assert not [line for line in mass.lines if line.get_label() == "limit"]  # it is far away
    assert "at most 500.0" in mass.get_title(loc="left")


@pytest.mark.parametrize(
    ("method", "more", "names"),
    [
        ("grid", "", ["best", "sweep"]),
        ("optimize", "", ["best", "sweep", "convergence"]),
        ("grid", f'"{LENGTH}" = {{ values = [30.0] }}\n', ["best", "parallel", "convergence"]),
    ],
)
def test_one_dimension_is_no_matter_for_parallel_axes(
    method: str, more: str, names: list[str], tmp_path: Path
) -> None:
    with drawn_figures():
        written = write_figures(tmp_path, swept(method, more))
    assert [path.stem for path in written] == names


@pytest.mark.parametrize("inputs", [1, pytest.param(3, marks=pytest.mark.long), 6])
@pytest.mark.parametrize("kind", ["even", "steep", "surface", "sample", "nothing", "constant"])
def test_a_tolerance_study_s_chart_can_be_read(kind: str, inputs: int, tmp_path: Path) -> None:
    """Bars of every length; with indices by surface, by the sample, without any."""
    own = tuple(ScatteredInput(k, 1.0, 0.1 / 3**0.5, 0.9, 1.1, False) for k in KEYS[:inputs])
    points = saltelli(own, 1024 if kind == "sample" else 16, 1)
    z = (points - 1) / 0.1
    weights = {"even": np.ones(inputs), "steep": 5.0 ** np.arange(inputs)}.get(
        kind, np.ones(inputs)
    )
    values = z @ weights
    if kind in ("sample", "nothing"):
        values = np.sin(np.pi * z[:, 0]) * 7 + np.cos(4 * z).sum(axis=1)
    if kind == "constant":
        values = 0 * values + 80
    keys = [x.key for x in own]
    rows = tuple(
        Row(i, dict(zip(keys, map(float, p), strict=True)), Outcome({TOTAL: 80.0 + float(v)}))
        for i, (p, v) in enumerate(zip(points, values, strict=True))
    )
    scatter = scatter_of(TOTAL, own, rows, 1)
    if kind == "nothing":
        scatter = replace(
            scatter, shares=replace(scatter.shares, indices=None, surface=None), tightened=()
        )
    with drawn_figures() as figures:
        write_scatter(tmp_path / "tolerance.png", scatter)
    above = figures[0].axes[0]  # the red line has a name, the range a source
    assert [t.get_text() for t in above.texts] == [f"mean {scatter.mean:.1f}"]
    assert ("quadratic fit" in above.get_title("left")) == bool(scatter.surface)
    assert [faults(f) for f in figures] == [[]]
