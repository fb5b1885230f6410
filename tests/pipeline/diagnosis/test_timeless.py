"""A record without time has rates per row, and nothing per second."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from histories import sweep

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.measurement.record import Sweep, read_measurement
from flexspline.pipeline.diagnosis.measurement.thinning import thinned
from flexspline.pipeline.diagnosis.model.doubt import Deviation
from flexspline.pipeline.diagnosis.model.extrapolation import extrapolated
from flexspline.pipeline.diagnosis.model.span import span_of
from flexspline.results.diagnosis.advice import why
from flexspline.results.diagnosis.prediction_words import beyond_words
from flexspline.results.diagnosis.structure_words import structure_words
from flexspline.results.diagnosis.summary import summary
from flexspline.results.diagnosis.words import magnitude_words
from flexspline.results.figures.diagnosis.contribution_parts import parts
from flexspline.results.figures.diagnosis.seen import seen

pytestmark = pytest.mark.usefixtures("causes_only")

DESIGN = load_design(EXAMPLES / "xb1-40.toml")


def lagging(path: Path, time: bool) -> Path:
    """Six cycles of an angle that lags torque by six rows, with a gap."""
    row = np.arange(600)
    torque = 0.7 * np.sin(2 * np.pi * row / 100)
    late = 0.7 * np.sin(2 * np.pi * (row - 6) / 100)
    noise = 0.2 * np.random.default_rng(6).standard_normal(600)
    angle = 11.35 * late + 36 * np.sign(torque) + noise
    head = "time_s," * time + "torque_Nm,angle_arcsec"
    rows = [
        f"{2.0 * i}," * time + f"{t:.6f},{a:.4f}"
        for i, t, a in zip(row, torque, angle, strict=True)
    ]
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(("time", "lag", "per"), [(True, 12.0, "s"), (False, 6.0, "row")])
def test_a_lag_is_per_second_or_per_row(time: bool, lag: float, per: str, tmp_path: Path) -> None:
    found = diagnose_file(DESIGN, lagging(tmp_path / "rig.csv", time), 31313, 43339)
    (cause,) = found.causes
    assert cause.magnitude == pytest.approx(
        11.35 * lag, rel=0.05
    )  # the median error of names is 2 %
    assert cause.unit == f"arcsec per N·m/{per}"
    assert magnitude_words(cause).endswith(f"N·m/{per}")
    assert ("N·m/s" in summary(found)) == time


def swinging(path: Path, time: bool, added_arcsec: np.ndarray) -> Path:
    """Six cycles of a straight line with a gap, and what is added to the angle."""
    row = np.arange(600)
    torque = 0.7 * np.sin(2 * np.pi * row / 100)
    noise = 0.2 * np.random.default_rng(3).standard_normal(600)
    angle = 11.35 * torque + 36 * np.sign(torque) + noise + added_arcsec
    head = "time_s," * time + "torque_Nm,angle_arcsec"
    rows = [
        f"{2.0 * i}," * time + f"{t:.6f},{a:.4f}"
        for i, t, a in zip(row, torque, angle, strict=True)
    ]
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return path


ADDED = {
    "a wave": 6 * np.sin(2 * np.pi * np.arange(600) / 240),
    "a stiffness that changes": 3.4 * np.sin(2 * np.pi * np.arange(600) / 100) * (np.arange(600) / 600) ** 2,
}  # fmt: skip


@pytest.mark.parametrize("what", ADDED)
@pytest.mark.parametrize("timed", [True, False])
def test_structure_lies_in_time_only_where_time_was_recorded(
    what: str, timed: bool, tmp_path: Path
) -> None:
    path = swinging(tmp_path / "rig.csv", timed, ADDED[what])
    found = diagnose_file(DESIGN, path, 31313, 43339)
    after = found.outcome.next_measurement
    assert after is not None
    told = [u.channel for u in found.outcome.unexplained]
    assert any(what in structure_words(u) for u in found.outcome.unexplained)
    assert ("time_s" in told) == timed
    assert ("row" in told) != timed
    shown = seen(found)
    assert shown is not None
    said = (
        summary(found), *map(structure_words, found.outcome.unexplained), why(after, "sweep").split(": ")[0],
        *(word for part in parts(shown) for word in (part.title, *part.lines)),
    )  # fmt: skip
    assert any("time" in line.replace("times", "") for line in said) == timed


@pytest.mark.parametrize(("timed", "unit"), [(True, "N·m/s"), (False, "N·m/row")])
def test_what_lies_beyond_the_record_too(timed: bool, unit: str) -> None:
    record = sweep()
    far = Deviation(np.ones(len(record)), {"torque_rate": 3})
    (line,) = map(beyond_words, extrapolated(far, span_of(record), record, timed))
    assert line.count(unit) == 2


def test_a_shortened_record_counts_its_own_rows(tmp_path: Path) -> None:
    """A lag is told in rows of the file, as `predict` counts them, not in means of several rows."""
    rows, cycles = 24_000, 4
    share = np.interp(np.arange(rows) * cycles / rows % 1, [0, 0.5, 1], [0, 1, 0])
    text = "".join(
        f"{i * cycles // rows + 1},{0.3 + 0.2 * s:.6f},{10 * s:.4f}\n" for i, s in enumerate(share)
    )
    path = tmp_path / "long.csv"
    path.write_text("cycle,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    read = read_measurement(path)
    assert isinstance(read, Sweep)
    short = thinned(read)
    numbers = short.history.time_or_rows(np.arange(len(short)))
    assert len(short) < rows / 2
    torque = 0.3 + 0.2 * np.interp(numbers * cycles / rows % 1, [0, 0.5, 1], [0, 1, 0])
    # the first block's mean is number 0; blocks are some four rows, and a corner is rounded over one
    assert short.history.torque_Nm == pytest.approx(torque, abs=0.2 * 2 * cycles / rows * 5)
