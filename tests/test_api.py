"""`import flexspline`: its names, when they load, its errors, and the page about it."""

from __future__ import annotations

import importlib
import inspect
import pickle
import re
import subprocess
import sys
from decimal import Decimal
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from example_files import EXAMPLES
from finished_run import FinishedRun

import flexspline
from flexspline.geometry.sanity import warnings

ROOT = Path(__file__).parents[1]
NAMES = {
    "load_design", "Design", "stiffness", "stress", "backlash", "sensitivity", "study", "diagnose",
    "predict", "gear", "FlexsplineError", "__version__",
}  # fmt: skip
SWEEP = EXAMPLES / "measured" / "xb1-40-sweep.csv"
ROOMS = ("geometry", "fea", "pipeline", "results")
ERRORS = [
    (path, name)
    for room in ROOMS
    for path in sorted((ROOT / room).rglob("*.py"))
    for name in re.findall(r"^class (\w+Error)\b", path.read_text(encoding="utf-8"), re.M)
]


def test_it_offers_these_names_and_no_others() -> None:
    assert set(flexspline.__all__) == NAMES
    assert set(dir(flexspline)) >= NAMES
    for name in NAMES:
        assert getattr(flexspline, name) is not None
    with pytest.raises(AttributeError, match="no_such"):
        _ = flexspline.no_such


def test_nothing_heavy_loads_before_it_is_used() -> None:
    code = "import sys, flexspline; print(len({'numpy', 'pydantic', 'skfem'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "0\n"


@pytest.mark.parametrize("name", sorted(NAMES - {"__version__"}))
def test_every_name_has_an_example_and_every_function_says_what_it_raises(name: str) -> None:
    found = getattr(flexspline, name)
    said = inspect.getdoc(found)
    assert ">>>" in said
    assert "Raises" in said or not inspect.isfunction(found)


def test_a_function_loads_nothing_heavy_before_it_is_called() -> None:
    code = (
        "import sys, flexspline\n"
        "functions = set(flexspline.__all__) - {'Design', 'load_design'}  # both are of pydantic\n"
        "found = [getattr(flexspline, name) for name in functions]\n"
        "print(sorted({'numpy', 'scipy', 'pydantic', 'skfem'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


@pytest.mark.parametrize(
    ("call", "missing"),
    [
        (
            "backlash(flexspline.load_design('examples/xb1-40.toml'), 3e4, 2e4)",
            {"scipy", "skfem", "flexspline.pipeline.analysis"},
        ),
        (
            "predict('none.toml', 'examples/measured/xb1-40-sweep.csv')",
            {"skfem", "flexspline.pipeline.analysis"},
        ),
    ],
)
def test_what_needs_no_solver_loads_none(call: str, missing: set[str]) -> None:
    """As the commands of the same names (`tests/test_architecture.py`)."""
    code = (
        "import sys, flexspline\n"
        f"try: flexspline.{call}\n"
        "except flexspline.FlexsplineError: pass\n"
        f"print(sorted({missing} & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT
    )
    assert done.stdout == "[]\n"


@pytest.mark.parametrize(("path", "name"), ERRORS, ids=[name for _, name in ERRORS])
def test_every_error_of_ours_has_one_root(path: Path, name: str) -> None:
    module = ".".join(("flexspline", *path.relative_to(ROOT).with_suffix("").parts))
    found = getattr(importlib.import_module(module), name)
    assert issubclass(found, flexspline.FlexsplineError) or not issubclass(found, BaseException)


def test_wrong_words_are_refused_in_one_line() -> None:
    design = flexspline.load_design(EXAMPLES / "xb1-40.toml")
    solid = design.changed({"solver.model": "solid", "flexspline.bolt_count": 0})
    for call in (
        lambda: flexspline.stiffness(design, "wave generator"),
        lambda: flexspline.stiffness(design, "flexspline", "no such case"),
        lambda: flexspline.stiffness(design, "shaft", "lobes"),
        lambda: flexspline.stiffness(solid, "flexspline", "lobes_contact"),  # never by tetrahedra
        lambda: flexspline.stress(design, "torque"),
        lambda: flexspline.backlash(design, K_b=-1.0, K_e=4e4),
        lambda: flexspline.backlash(design, K_b="3e4", K_e=4e4),
        lambda: flexspline.backlash(design, K_b=3e4, K_e=10**400),
        lambda: flexspline.backlash(design, K_e="4e4"),  # before K_b is solved
        lambda: flexspline.diagnose(design, SWEEP, K_b="3e4", K_e=4e4),
        lambda: flexspline.diagnose(design, "no such file.csv"),
        lambda: flexspline.study("no such study.toml"),
        lambda: flexspline.study(EXAMPLES / "studies" / "grid.toml", out="/dev/null/out"),
        lambda: flexspline.load_design(None),
        lambda: flexspline.study(None),
        lambda: flexspline.diagnose(design, {"torque_Nm": [1.0]}),
        lambda: flexspline.backlash(design, K_b=True, K_e=4e4),
        lambda: flexspline.backlash(design, K_b=np.bool_(True), K_e=4e4),
        lambda: flexspline.study(EXAMPLES / "studies" / "grid.toml", out=3),
        lambda: flexspline.stiffness(design, np.array(["shaft", "flexspline"])),
        lambda: delattr(design, "load"),
        lambda: design.changed(None),
        lambda: design.changed({3: 4.0}),
        lambda: setattr(design.flexspline, "length_mm", 25.0),
        lambda: design.changed({"flexspline.wall": 0.4}),
        lambda: design.changed({"flexspline.bolt_count": "six"}),
        lambda: flexspline.Design(),
        lambda: flexspline.Design(**design.tables | {"flexspline": None}),
        lambda: flexspline.Design(**design.tables | {"flexspline": object()}),
        lambda: flexspline.Design(**design.tables | {"load": {"torque_Nm": "much"}}),
    ):
        with pytest.raises(flexspline.FlexsplineError) as caught:
            call()
        assert str(caught.value)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "name", ["stiffness", "stress", "backlash", "gear", "sensitivity", "diagnose"]
)
@pytest.mark.parametrize("given", ["examples/xb1-40.toml", Path("cup.toml"), {"name": "cup"}, None])
def test_a_path_in_place_of_a_design_is_answered_with_how_to_load_it(
    name: str, given: object
) -> None:
    more = ("sweep.csv",) if name == "diagnose" else ()
    with pytest.raises(flexspline.FlexsplineError, match=r"flexspline\.load_design") as caught:
        getattr(flexspline, name)(given, *more)
    assert isinstance(caught.value, TypeError)
    assert "\n" not in str(caught.value)
    if isinstance(given, str | Path):
        assert f'flexspline.load_design("{given}")' in str(caught.value)


def test_a_design_of_tables_is_that_of_the_file() -> None:
    design = flexspline.load_design(EXAMPLES / "xb1-40.toml")
    assert flexspline.Design(**design.tables) == design
    with pytest.raises(flexspline.FlexsplineError, match=r"load\.torque_Nm = -1: must be"):
        flexspline.Design(**design.tables | {"load": {"torque_Nm": -1}})


@pytest.fixture(scope="module")
def diagnosed() -> Any:
    """Of the example's sweep."""
    design = flexspline.load_design(EXAMPLES / "xb1-40.toml")
    return flexspline.diagnose(design, SWEEP, K_b=31377, K_e=43275)


def test_a_model_answers_a_history_without_rows(diagnosed: Any) -> None:
    model = diagnosed.model
    assert model.angle_arcsec([], temperature_C=[]).shape == (0,)
    one = model.angle_arcsec(1.0, temperature_C=25.0)
    assert one == model.angle_arcsec([1.0], temperature_C=[25.0])


@pytest.mark.parametrize(
    ("torque", "channels", "needle"),
    [
        ("much", {}, "torque_Nm must hold numbers"),
        ([0.0, 1e300], {"temperature_C": [20.0, 20.0]}, r"torque_Nm = 1e\+300 is beyond"),
        ([1j, 2.0], {}, "torque_Nm must hold numbers"),
        ([[1.0, 2.0], [3.0]], {}, "torque_Nm must hold numbers"),
        (
            [0.0, 1.0],
            {"time_s": [1.0, 0.0], "temperature_C": [20.0, 20.0]},
            "time_s runs backwards",
        ),
    ],
)
def test_a_model_refuses_a_history_that_is_none(
    diagnosed: Any, torque: Any, channels: dict[str, list[float]], needle: str
) -> None:
    with pytest.raises(flexspline.FlexsplineError, match=needle):
        diagnosed.model.angle_arcsec(torque, **channels)


def test_changed_is_a_new_design() -> None:
    design = flexspline.load_design(EXAMPLES / "xb1-40.toml")
    longer = design.changed({"flexspline.length_mm": 35.0, "shaft.segment[1].length_mm": 12.0})
    assert (longer.flexspline.length_mm, longer.shaft.segment[1].length_mm) == (35.0, 12.0)
    assert design.flexspline.length_mm != 35.0


def test_a_design_that_no_file_may_hold_is_not_solved() -> None:
    """`Design(…)` and pydantic's copies look at one key at a time."""
    design = flexspline.load_design(EXAMPLES / "xb1-40.toml")
    tables = design.tables
    tables["flexspline"]["wall_thickness_mm"] = 5.0  # the ring is 0.55 thick
    thin = design.flexspline.model_copy(update={"wall_thickness_mm": -0.5})
    for wrong in (flexspline.Design(**tables), design.model_copy(update={"flexspline": thin})):
        with pytest.raises(flexspline.FlexsplineError, match="thickness_mm"):
            flexspline.stiffness(wrong)


@pytest.mark.parametrize("value", [np.int64(4), np.float64(4.0), np.array(4), 4.0])
def test_numpy_s_numbers_are_numbers(value: object) -> None:
    design = flexspline.load_design(EXAMPLES / "xb1-40.toml")
    changed = design.changed({"flexspline.bolt_count": value})
    assert changed == design.changed({"flexspline.bolt_count": 4})
    with pytest.raises(
        flexspline.FlexsplineError, match=r"shaft\.keyway\.width_mm = 4\.?0?: no such key"
    ):
        design.changed({"shaft.keyway.width_mm": value})


@pytest.mark.parametrize("value", [np.float32(3e4), np.int16(30_000), Decimal(30_000)])
def test_a_stiffness_given_is_a_double(value: Any) -> None:
    """As figures of four bytes are no JSON and lose their last digits."""
    design = flexspline.load_design(EXAMPLES / "xb1-40.toml")
    found = flexspline.backlash(design, K_b=value, K_e=4e4)
    assert found == flexspline.backlash(design, K_b=3e4, K_e=4e4)
    assert type(found.flexspline_arcsec) is float


@pytest.mark.parametrize("value", [np.array([0.7, 0.8]), np.array([0.7]), [0.7, 0.8]])
def test_several_numbers_are_refused_as_a_list(value: object) -> None:
    design = flexspline.load_design(EXAMPLES / "xb1-40.toml")
    with pytest.raises(
        flexspline.FlexsplineError, match=r"must be a number, not a list; it must be from "
    ):
        design.changed({"flexspline.wall_thickness_mm": value})


def test_a_diagnosis_is_shown_in_short_and_goes_to_another_process(
    diagnosed: Any,
) -> None:
    design, found = flexspline.load_design(EXAMPLES / "xb1-40.toml"), diagnosed
    assert len(repr(found)) < 10_000  # a notebook prints it
    there = pickle.loads(pickle.dumps(found))
    assert there.verdict == found.verdict
    torque, warm = [1.0, -1.0], {"temperature_C": [30.0, 30.0]}
    assert np.array_equal(
        there.model.angle_arcsec(torque, **warm), found.model.angle_arcsec(torque, **warm)
    )
    with pytest.raises(
        flexspline.FlexsplineError, match='against = "curve": must be "sum" or "gear"'
    ):
        flexspline.diagnose(design, SWEEP, 31312, 43275, against="curve")


def test_what_is_unusual_is_a_warning_where_the_function_was_called() -> None:
    design = flexspline.load_design(EXAMPLES / "xb1-40.toml")
    odd = design.changed({"flexspline.bolt_count": 5})  # the shaft has six
    with pytest.warns(UserWarning, match="bolt") as caught:
        flexspline.backlash(odd, K_b=3e4, K_e=4e4)
    assert [str(w.message) for w in caught] == list(warnings(odd))
    assert {w.filename for w in caught} == {__file__}


def test_a_design_s_text_is_a_file_of_it(tmp_path: Path) -> None:
    design = flexspline.load_design(EXAMPLES / "hat-25.toml").changed({"load.torque_Nm": 3.0})
    (tmp_path / "mine.toml").write_text(design.toml, encoding="utf-8")
    assert flexspline.load_design(tmp_path / "mine.toml") == design


def test_lift_off_lies_between_the_seat_held_and_the_rim_free() -> None:
    """Contact that only pushes does less than a seat that also pulls, and more than none."""
    design = flexspline.load_design(EXAMPLES / "xb1-40.toml")
    plain = design.changed({"flexspline.bolt_count": 0})
    free, contact, held = (
        flexspline.stiffness(plain, "flexspline", case)
        for case in ("lobes_unsupported", "lobes_contact", "lobes")
    )
    assert free.bounds_Nm_per_rad[0] < contact.K_Nm_per_rad < held.bounds_Nm_per_rad[1]
    assert not contact.guaranteed


def test_the_command_prints_the_version() -> None:
    line = [sys.executable, "-m", "flexspline.results.cli", "--version"]
    done = subprocess.run(line, capture_output=True, text=True, check=True)
    assert done.stdout == f"{flexspline.__version__}\n" == f"{version('flexspline')}\n"


def test_the_page_runs(
    finished_cup: FinishedRun, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Every block of docs/python.md, one after the other, as in a notebook."""
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.S)
    assert len(blocks) >= 5
    (tmp_path / "examples").symlink_to(EXAMPLES)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    names: dict[str, object] = {"__name__": "__main__"}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)


@pytest.mark.long
def test_solid_and_axisymmetric_model_agree_on_a_free_rim_without_holes() -> None:
    """Two discretisations of one case, each to 5 %: their bounds overlap."""
    text = {"flexspline.bolt_count": 0, "solver.tolerance_pct": 5.0}
    plain = flexspline.load_design(EXAMPLES / "xb1-40.toml").changed(text)
    solid = plain.changed({"solver.model": "solid"})
    (low, high), (lower, upper) = (
        flexspline.stiffness(design, "flexspline", "lobes_unsupported").bounds_Nm_per_rad
        for design in (plain, solid)
    )
    assert max(low, lower) <= min(high, upper)
