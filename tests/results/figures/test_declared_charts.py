"""Every chart of a run is declared in its own file and listed once; its picture is kept by what it shows."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from pathlib import Path

import pytest
from hand_made_curve import gear_curve
from hand_made_gear import BACKLASH, K_B, K_E, content, design
from unlike_gears import GEARS

from flexspline.pipeline.analysis import RunResult
from flexspline.pipeline.linear_limit import linear_limit
from flexspline.pipeline.stiffnesses import Stiffnesses
from flexspline.results import figures
from flexspline.results.drawings import charts
from flexspline.results.figures.chart import chart
from flexspline.results.file_names import CHARTS
from flexspline.results.report.spans import words

CURVE = gear_curve(23.2, 474.0, 108.0)
EXTENDED = next(gear.extended for gear in GEARS.values() if gear.extended is not None)


def run(**changes) -> RunResult:
    """A run without fields whose stiffnesses were solved on several meshes."""
    found = Stiffnesses({"K_b": K_B, "K_e": K_E})
    limit = linear_limit(design(), 16687.0)
    return replace(RunResult(design(), (), found, {}, BACKLASH, limit, {}, CURVE), **changes)


def keys(result: RunResult, extended=None) -> dict[str, object]:
    return {one.name: one.key for one in charts(result, extended)}


def test_every_file_with_a_chart_is_listed_once() -> None:
    files = Path(figures.__path__[0]).glob("*.py")
    modules = {p.stem: import_module(f"{figures.__name__}.{p.stem}") for p in files}
    assert sorted(CHARTS) == sorted(n for n, m in modules.items() if hasattr(m, "CHART"))


@pytest.mark.parametrize("name", CHARTS)
def test_every_chart_has_a_sentence_below_it(name: str) -> None:
    said = "".join(s.text for s in words(chart(name).caption(content())))
    assert said.endswith(".")


def test_a_run_without_a_gear_or_a_second_mesh_has_the_other_charts() -> None:
    every = keys(run())
    assert list(every) == [name for name in CHARTS if name in every]
    one_mesh = {name: replace(K, levels=K.levels[-1:]) for name, K in (("K_b", K_B), ("K_e", K_E))}
    left = keys(run(gear=None, stiffnesses=Stiffnesses(one_mesh)))
    assert set(every) - set(left) == {"gear_torque_angle", "gear_loads", "convergence"}


@pytest.mark.parametrize(
    ("changes", "drawn_again"),
    [
        ({}, set()),
        ({"stage_seconds": {"pictures": 1.0}}, set()),
        ({"backlash": replace(BACKLASH, bearing_play_arcsec=40.0)}, {"backlash_budget", "torque_angle"}),
        ({"gear": replace(CURVE, K1_Nm_per_rad=1.0)}, {"gear_torque_angle", "gear_loads"}),
        ({"stiffnesses": Stiffnesses({"K_b": K_B.times(2.0), "K_e": K_E})},
         {"torque_angle", "convergence"}),
    ],
)  # fmt: skip
def test_a_chart_is_drawn_again_where_what_it_shows_changed(changes, drawn_again) -> None:
    before, after = keys(run()), keys(run(**changes))
    assert {name for name in before if before[name] != after[name]} == drawn_again


def test_only_the_budget_shows_an_extended_model() -> None:
    before, after = keys(run()), keys(run(), EXTENDED)
    assert {name for name in before if before[name] != after[name]} == {"backlash_budget"}
