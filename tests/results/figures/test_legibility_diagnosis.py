"""The figures of a diagnosis can be read, whatever was measured."""

from math import pi, sin
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from legibility import assert_legible, drawn_figures, faults
from matplotlib.figure import Figure
from typer.testing import CliRunner

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.left_out import LeftOut
from flexspline.pipeline.diagnosis.outcome import Gain
from flexspline.results.cli import app
from flexspline.results.diagnosis.data_used import data_record
from flexspline.results.figures.diagnosis.captions import caption
from flexspline.results.figures.diagnosis.contributions import write_contributions
from flexspline.results.figures.diagnosis.held_out import write_held_out
from flexspline.results.figures.diagnosis.overview import write_overview
from flexspline.results.figures.diagnosis.panels import write_channels
from flexspline.results.figures.diagnosis.seen import seen

CUP = EXAMPLES / "xb1-40.toml"
MEASURED = EXAMPLES / "measured"
COMPLIANCE, GAP = 11.343, 72.2
"""arcsec per N·m and arcsec, of the example with the stiffnesses below."""


def sweep(path, extra, units=("u0",), cycles=5, scale=1.0, columns=()):
    """Triangles of 60 rows to ±2 N·m; `extra(torque, row, unit)` [arcsec] is added."""
    rng = np.random.default_rng(4)
    lines = [",".join(("unit", "cycle", "time_s", *columns, "torque_Nm", "angle_arcsec"))]
    for u, name in enumerate(units):
        for i in range(60 * cycles):
            torque = 2 * (1 - 4 * abs(((i + 0.5) / 60 + 0.25) % 1 - 0.5))
            angle = COMPLIANCE * torque + GAP / 2 * np.sign(torque) + extra(torque, i, u)
            angle = scale * (angle + rng.normal(0, 0.3))
            own = {"temperature_C": 20 + i / 20, "input_angle_deg": (30 * (i // 60)) % 360}
            more = [f"{own[c]:g}" for c in columns]
            lines.append(
                ",".join((name, f"{i // 60}", f"{40 * i}", *more, f"{torque:.5f}", f"{angle:.4f}"))
            )
    path.write_text("\n".join(lines) + "\n")
    return path


def branch(row):
    """1 while torque rises, −1 while it falls."""
    return 1 if ((row + 0.5) / 60 + 0.25) % 1 < 0.5 else -1


def many(torque, row, unit):
    """Friction, drift, a gap that changes with temperature, an offset, position error."""
    drift, gap = 0.01 * row, np.sign(torque) * 0.05 * row
    return -3 * branch(row) + drift + gap + 6 * sin(2 * pi * ((row // 60) * 30) / 360)


def softer_places(torque, row, unit):
    """Stiffness that differs by 10 % with the wave generator's position."""
    return 0.1 * COMPLIANCE * torque * np.cos(2 * np.radians(30 * (row // 60)))


def end_points(path, units):
    rng = np.random.default_rng(2)
    lines = ["unit,torque_Nm,angle_plus_arcsec,angle_minus_arcsec"]
    for i, name in enumerate(units):
        half = 41.7 + rng.normal(0, 4) + (4000 if i == 2 else 0)
        lines.append(f"{name},0.5,{half + 3:.2f},{-half + 3:.2f}")
    path.write_text("\n".join(lines) + "\n")
    return path


def end_points_at_torques(path):
    """Six units with more gap and a common change of zero with the torque: pairs of causes are likely."""
    lines = ["unit,torque_Nm,angle_plus_arcsec,angle_minus_arcsec"]
    for i in range(6):
        for torque in (2, 6, 12):
            half, middle = GAP / 2 + 20 + COMPLIANCE * torque, 3 * torque + (7 * i) % 5
            lines.append(f"{i + 1},{torque},{half + middle:.2f},{middle - half:.2f}")
    path.write_text("\n".join(lines) + "\n")
    return path


def specimens(path, names, keys):
    """Of four designs in turn: each design is a set of solves."""
    rng = np.random.default_rng(1)
    lines = [",".join(("specimen", "part", *keys, "stiffness_Nm_per_rad"))]
    for i, name in enumerate(names):
        values = [f"{each[i % 4]:g}" for each in keys.values()]
        K = 0.8 * 31329 * (1 + 0.01 * rng.normal())
        lines.append(",".join((name, "flexspline", *values, f"{K:.0f}")))
    path.write_text("\n".join(lines) + "\n")
    return path


LONG = [f"unit of the second shift; bench {i}" for i in range(4)]
DIMENSIONS = {
    "flexspline.length_mm": (30.0, 24.0, 36.0, 33.0),
    "flexspline.wall_thickness_mm": (0.4, 0.45, 0.5, 0.4),
    "flexspline.diaphragm_thickness_mm": (0.6, 0.8, 0.6, 0.9),
}  # fmt: skip
"""The first four of the measured example's: the suite's cache holds their solves for other tests too."""
RECORDS = {
    "example sweep": lambda f: MEASURED / "xb1-40-sweep.csv",
    "nothing wrong": lambda f: sweep(f, lambda *_: 0.0),
    "one cycle": lambda f: sweep(f, lambda t, i, u: -4 * branch(i), cycles=1),
    "every channel": lambda f: sweep(
        f, many, cycles=5, columns=("temperature_C", "input_angle_deg")
    ),
    "unknown": lambda f: sweep(f, lambda t, i, u: (0.0, 9.0, -4.0, 14.0, 3.0)[i // 60]),
    "units with long names": lambda f: sweep(
        f, lambda t, i, u: -3 * branch(i) * (u != 1), LONG, cycles=2
    ),
    "units in other letters": lambda f: sweep(
        f, lambda t, i, u: -3 * branch(i) * u, ("Größe 1", "名前", "$x$", "d"), cycles=3
    ),
    "thirty units": lambda f: sweep(
        f, lambda t, i, u: -3 * branch(i), [f"A-{i:03d}" for i in range(12)], cycles=2
    ),
    "large effect": lambda f: sweep(f, lambda t, i, u: -40 * branch(i)),
    "example end points": lambda f: MEASURED / "size-40-end-points.csv",
    "end points, one far out": lambda f: end_points(f, [*LONG, "b", "c", "d"]),
    "end points of many": lambda f: end_points(f, [f"{i}" for i in range(60)]),
    "end points at several torques": end_points_at_torques,
    "example specimens": lambda f: MEASURED / "xb1-40-specimens.csv",
    "specimens": lambda f: specimens(f, [f"S{i}" for i in range(8)], {"flexspline.length_mm": (30.0,) * 4}),
    "specimens with long names": lambda f: specimens(
        f, [f"batch of 2026; no. {i}" for i in range(14)], DIMENSIONS
    ),
}  # fmt: skip


SLOW = (
    "example specimens", "specimens",  # each a set of solves; one more of the kind stays
    "example sweep", "nothing wrong", "one cycle", "large effect", "thirty units", "example end points",
    "units in other letters", "end points of many",
)  # fmt: skip
"""Of each the like stays by default, with more in it or with longer names."""
RUNS = [pytest.param(n, marks=[pytest.mark.long] if n in SLOW else []) for n in RECORDS]


@pytest.mark.parametrize("name", RUNS)
def test_figures_of_a_diagnosis(tmp_path, monkeypatch, name):
    monkeypatch.setattr(
        "flexspline.results.diagnosis.files.reports_of", lambda *_, **__: {}
    )  # only figures
    record = RECORDS[name](tmp_path / "m.csv")
    words = ["diagnose", CUP, record, "--Kb", 31329, "--Ke", 43339, "--out", tmp_path / "o"]
    with drawn_figures() as found:
        result = CliRunner().invoke(app, [str(w) for w in words])
    assert result.exit_code == 0, result.stderr
    assert len(found) >= 2
    assert [fault for figure in found for fault in faults(figure)] == []


def test_the_title_of_an_axis_is_no_longer_than_the_axis(tmp_path: Path) -> None:
    """Added compliance has the longest of a cause's panel."""
    path = sweep(tmp_path / "m.csv", softer_places, cycles=12, columns=("input_angle_deg",))
    shown = seen(diagnose_file(load_design(CUP), path, 31329, 43339))
    assert shown is not None
    with drawn_figures() as figures:
        write_contributions(tmp_path / "c.png", shown)
    assert_legible(figures)
    titles = [axes.yaxis.label for axes in figures[0].axes]
    assert any("added compliance" in title.get_text() for title in titles)
    for axes in figures[0].axes:
        assert axes.yaxis.label.get_window_extent().height <= axes.bbox.height


def test_points_that_are_moved_are_said_to_be(tmp_path: Path) -> None:
    """Five cycles, each at one angle of the wave generator: both branches would hide each other there."""
    path = sweep(tmp_path / "m.csv", many, columns=("temperature_C", "input_angle_deg"))
    found = diagnose_file(load_design(CUP), path, 31329, 43339)
    shown = seen(found)
    assert shown is not None
    with drawn_figures() as figures:
        write_channels(tmp_path / "r.png", shown, shown.calibrated, "Residual")
    labels = {axes.get_xlabel() for axes in figures[0].axes}
    assert {label for label in labels if label.endswith("(branches apart)")} == {
        "load cycle (branches apart)", "wave generator angle in ° (branches apart)"
    }  # fmt: skip
    for name in ("residual_simulation", "residual_model", "residual_unknown"):
        assert "rising torque to the left of its value" in caption(name, where="torque")


def test_mean_lines_lie_inside_their_frame(tmp_path: Path) -> None:
    """Twenty arcsec in one cycle of five are in fewer rows than the frame's height is set by."""
    path = sweep(tmp_path / "m.csv", lambda *_: 0.0)
    shown = seen(diagnose_file(load_design(CUP), path, 31329, 43339))
    assert shown is not None
    left = np.zeros(len(shown.kept))
    some = np.flatnonzero(shown.kept & (shown.history.cycle == 1) & (shown.output_Nm > 0))
    left[some] = 20 * shown.noise_arcsec
    few = some[: len(some) // 4]
    left[some[len(few) :]] = 0.0
    with drawn_figures() as figures:
        write_channels(tmp_path / "r.png", shown, left, "Residual")
    for axes in figures[0].axes:
        low, high = axes.get_ylim()
        for line in axes.lines:
            if line.get_marker() == "None" and len(line.get_ydata()):
                assert low <= min(line.get_ydata()) <= max(line.get_ydata()) <= high


def test_the_legend_counts_each_kind_of_row_that_was_not_used(tmp_path: Path) -> None:
    path = sweep(tmp_path / "m.csv", lambda *_: 0.0)
    diagnosis = diagnose_file(load_design(CUP), path, 31329, 43339)
    shown = seen(diagnosis)
    assert shown is not None
    with drawn_figures() as found:
        write_overview(tmp_path / "m.png", shown)
    (figure,) = found
    (said,) = [t for t in legend_texts(figure) if t.startswith("not used")]
    left = data_record(diagnosis)["rows"]["left_out"]
    assert left["outlier"] == 0
    assert said == (
        f"not used: gap crossed ({left['backlash_crossing']}), at reversals ({left['torque_reversal']}), "
        f"before the first reversal ({left['before_first_reversal']})"
    )


def test_a_title_names_cycles_of_many_units_as_far_as_there_is_room(tmp_path: Path) -> None:
    """Each unit has its own numbers, which would fill three titles."""
    own = tuple((f"gear-{u}", (100.0 * u + 2, 100.0 * u + 5)) for u in range(1, 8))
    left = {name: np.array([3.0, -3.0, 2.0]) for name in ("before", "calibrated", "after")}
    gain = Gain(LeftOut("cycle", of_units=own), 3.0, 2.0, 1.0, 0.5, left=left)
    with drawn_figures() as figures:
        write_held_out(tmp_path / "held_out.png", gain)
    assert_legible(figures)


def legend_texts(figure: Figure) -> list[str]:
    return [t.get_text() for legend in figure.legends for t in legend.get_texts()]
