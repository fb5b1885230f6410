"""An angle reading that comes late takes the gap's step with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from hidden.adapter import diagnose
from hidden.cases import draw_case
from histories import LARGEST, PREDICTION, triangle
from read_sweep import as_read

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.structure import LateAngle
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import PreparedSweep, prepare
from flexspline.pipeline.diagnosis.sweep.rig_faults.crossing_forms import filtered_side
from flexspline.pipeline.diagnosis.sweep.rig_faults.late_angle import late_angle_of
from flexspline.results.diagnosis.advice import why
from flexspline.results.diagnosis.structure_words import structure_words

FINE, EVERY = 2000, 20
"""Rows of a cycle of the true course, and of which one each is read: 100 rows a cycle."""
NOISE, TORQUE_NOISE = 0.3, 0.002
"""Arcsec, N·m."""
ONE_RATE, FOUR_RATES = (60.0,) * 4, (240.0, 60.0, 120.0, 30.0)
"""Periods [s]; rates of 8 N·m in each."""
Course = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""What a function of time [s] and of a quantity is read as."""


def through_filter(time: np.ndarray, values: np.ndarray, filter_s: float) -> np.ndarray:
    """A first-order filter, R' = (v − R)/τ, by small steps."""
    keep = np.exp(-np.diff(time) / filter_s).tolist()
    means = ((values[1:] + values[:-1]) / 2).tolist()
    read = [float(values[0])]
    for k, mean in zip(keep, means, strict=True):
        read.append(mean + (read[-1] - mean) * k)
    return np.array(read)


def curve(torque: np.ndarray) -> np.ndarray:
    """Of an elastic gear with a gap of 60 arcsec."""
    return 10.0 * torque + 30.0 * np.sign(torque)


def straight(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    return values


def rig(
    periods_s: tuple[float, ...],
    angle_of: Course,
    torque_of: Course = straight,
    seed: int = 23,
) -> PreparedSweep:
    """What a rig reads, with `angle_of` and `torque_of` between the true course and its two readings."""
    torque = np.concatenate([[0.0], np.tile(triangle(FINE, 0), len(periods_s))])
    time = np.concatenate([[0.0], np.cumsum(np.repeat(np.array(periods_s) / FINE, FINE))])
    rows = np.arange(1 + EVERY // 2, len(torque), EVERY)
    rng = np.random.default_rng(seed)
    none = np.zeros(len(rows), int)
    read = torque_of(time, torque)[rows] + rng.normal(0, TORQUE_NOISE, len(rows))
    history = History(read, none, (rows - 1) // FINE, time[rows])
    angle = angle_of(time, torque)[rows] + rng.normal(0, NOISE, len(rows))
    return prepare(as_read(history, angle), PREDICTION)


def filtered(periods_s: tuple[float, ...], filter_s: float) -> PreparedSweep:
    """Of an angle read through a filter, which is found with its time."""
    prepared = rig(periods_s, lambda t, q: through_filter(t, curve(q), filter_s))
    found = late_angle_of(prepared)
    assert found is not None
    assert found.kind == "filter"
    # the torque's noise moves the step among few rows: three deviations, and a tenth of the time
    assert found.time_s == pytest.approx(filter_s, abs=3 * found.std_s, rel=0.1)
    return prepared


def test_a_filter_of_the_angle_is_found_with_its_time() -> None:
    filtered(FOUR_RATES, 1.5)


@pytest.mark.usefixtures("causes_only")
@pytest.mark.parametrize(
    ("periods_s", "filter_s"),
    [
        pytest.param(ONE_RATE, 0.5, id="one rate, quick"),
        pytest.param(FOUR_RATES, 1.5, id="four rates, slow", marks=pytest.mark.long),
        pytest.param(ONE_RATE, 1.5, id="one rate, slow", marks=pytest.mark.long),
        pytest.param(FOUR_RATES, 0.5, id="four rates, quick", marks=pytest.mark.long),
    ],
)
def test_a_filter_of_the_angle_is_said_with_its_time(
    periods_s: tuple[float, ...], filter_s: float
) -> None:
    prepared = filtered(periods_s, filter_s)
    outcome = diagnose_sweep(prepared.sweep, PREDICTION)[0]
    assert (outcome.verdict, outcome.causes) == ("unknown", ())
    (left,) = outcome.unexplained
    assert isinstance(left.structure, LateAngle)
    assert left.limit
    said = structure_words(left)
    assert "looks as if the angle reading follows the torque through a filter" in said
    assert "would look the same" in said
    assert "loose key" in said
    assert outcome.next_measurement is not None
    assert "filters of the torque channel and the angle channel" in why(
        outcome.next_measurement, "sweep"
    )


def test_a_delay_of_the_angle_is_told_at_one_rate_and_where_rates_differ() -> None:
    delay_s = 1.0

    def delayed(time: np.ndarray, torque: np.ndarray) -> np.ndarray:
        return curve(np.interp(time - delay_s, time, torque))

    found = late_angle_of(rig(FOUR_RATES, delayed))
    assert found is not None
    assert found.kind == "delay"
    assert found.time_s == pytest.approx(delay_s, abs=3 * found.std_s, rel=0.15)
    # at one rate the step comes late by one torque, as behind friction ahead of the teeth, which holds the
    # twist at the turns; the step lies somewhere between two rows
    at_one = late_angle_of(rig(ONE_RATE, delayed))
    assert at_one is not None
    assert at_one.kind == "delay"
    assert at_one.time_s == pytest.approx(delay_s, abs=ONE_RATE[0] / 100)


@pytest.mark.usefixtures("causes_only")
def test_a_late_reading_is_not_taken_for_the_gap() -> None:
    """Terms without a name that follow the delay would leave a third less, and be sure of it."""

    def delayed(time: np.ndarray, torque: np.ndarray) -> np.ndarray:
        return curve(np.interp(time - 3.0, time, torque))

    outcome, analysis = diagnose_sweep(rig(FOUR_RATES, delayed).sweep, PREDICTION)
    assert isinstance(outcome.unexplained[0].structure, LateAngle)
    assert analysis is not None
    gap = analysis.calibration.gap_arcsec
    assert gap.value == pytest.approx(60.0, abs=3 * gap.std)


def test_one_filter_of_both_readings_is_told() -> None:
    filter_s = 1.0
    found = late_angle_of(
        rig(
            ONE_RATE,
            lambda t, q: through_filter(t, curve(q), filter_s),
            lambda t, q: through_filter(t, q, filter_s),
        )
    )
    assert found is not None
    assert found.kind == "both"
    assert found.time_s == pytest.approx(filter_s, abs=3 * found.std_s, rel=0.1)


def ahead(time: np.ndarray, torque: np.ndarray) -> np.ndarray:
    """Coulomb friction of 0.12 N·m between the torque cell and the teeth."""
    carried = np.empty(len(torque))
    state = 0.0
    for i, step in enumerate(np.diff(torque, prepend=0.0).tolist()):
        state = min(max(state + step, -0.12), 0.12)
        carried[i] = state
    return curve(torque - carried)


def lagging(time: np.ndarray, torque: np.ndarray) -> np.ndarray:
    """Twist that lags; the teeth change sides where the torque does."""
    return curve(torque) - 10.0 * (torque - through_filter(time, torque, 1.5))


@pytest.mark.parametrize("periods_s", [ONE_RATE, FOUR_RATES])
@pytest.mark.parametrize(
    ("angle_of", "torque_of"),
    [
        (ahead, straight),
        (lagging, straight),
        (lambda t, q: curve(q), lambda t, q: q + 0.1),
        (lambda t, q: curve(q), lambda t, q: through_filter(t, q, 1.0)),
        (lambda t, q: curve(q) + 8.0 * np.tanh(q / 0.3), straight),
    ],
    ids=["friction ahead", "lagging twist", "torque offset", "late torque", "soft wind-up"],
)
def test_what_else_moves_or_bends_the_crossing_is_no_late_angle(
    periods_s: tuple[float, ...], angle_of: Course, torque_of: Course
) -> None:
    for seed in range(2):
        assert late_angle_of(rig(periods_s, angle_of, torque_of, seed)) is None


def test_without_time_nothing_is_late() -> None:
    prepared = rig(ONE_RATE, lambda t, q: through_filter(t, curve(q), 1.5))
    history = replace(prepared.sweep.history, time_s=None)
    assert late_angle_of(replace(prepared, sweep=replace(prepared.sweep, history=history))) is None


def test_a_filtered_sign_is_exact_between_rows() -> None:
    """x' = (sign T − x)/τ, by steps a thousand times shorter than the rows."""
    time = np.array([0.0, 1.0, 2.5, 3.0, 4.0, 6.0])
    torque = np.array([-1.0, -0.4, 0.8, 0.1, -0.3, -0.2]) * LARGEST
    fine = np.linspace(0.0, 6.0, 60_001)
    exact = through_filter(fine, np.sign(np.interp(fine, time, torque)), 0.8)
    none = np.zeros(len(time), int)
    found = filtered_side(History(torque, none, none, time), torque, 0.8)
    assert found == pytest.approx(np.interp(time, fine, exact), abs=2e-4)


@pytest.mark.long
def test_friction_of_a_form_that_no_element_has_is_no_late_reading() -> None:
    """A staircase; a few rows on the wrong side of the gap bent what stood beside the step to a delay."""
    found = diagnose(draw_case(1500001, 152))
    assert [c["id"] for c in found["causes"]] == ["friction_hysteresis"]


@pytest.mark.parametrize(
    "friction_Nm", [1.5, *(pytest.param(f, marks=pytest.mark.long) for f in (3.0, 9.0))]
)
@pytest.mark.parametrize("seed", [0, *(pytest.param(s, marks=pytest.mark.long) for s in (1, 2))])
def test_coulomb_friction_ahead_of_the_teeth_at_one_rate_is_no_late_reading(
    friction_Nm: float, seed: int, tmp_path: Path
) -> None:
    """Between turns a delay of F/rate crosses the gap where friction F does; at a turn friction holds the
    twist for 2 F, and a delay lets it go on. A stiff gear with little noise: 13 of 24 were late readings."""
    rng = np.random.default_rng(seed)
    peaks = np.array([15.0, 30.0, 30.0, 50.0, 50.0, 50.0])
    ends = np.concatenate([[0.0], np.column_stack([peaks, -peaks, 0 * peaks]).ravel()])
    at = np.concatenate([[0.0], np.abs(np.diff(ends)).cumsum()])  # 1 N·m/s
    time = np.arange(0.0, at[-1], 0.47)
    torque = np.interp(time, at, ends)
    teeth, held = np.empty(len(time)), 0.0
    for k, now in enumerate(torque.tolist()):
        held = min(max(held, now - friction_Nm), now + friction_Nm)
        teeth[k] = held
    angle = 0.6345 * teeth + 42.9 * np.where(teeth > 0, 1.0, -1.0)
    read = (torque + rng.normal(0, 0.03, len(time)), angle + rng.normal(0, 0.8, len(time)))
    cycle = 1 + np.searchsorted(at[3::3], time, side="right")
    path = tmp_path / "rubs.csv"
    rows = np.column_stack([cycle, time, *read])
    head = "cycle,time_s,torque_Nm,angle_arcsec"
    np.savetxt(
        path, rows, fmt=["%d", "%.2f", "%.3f", "%.2f"], delimiter=",", header=head, comments=""
    )
    design = load_design(EXAMPLES / "xb1-40.toml")
    found = diagnose_file(design, path, 2 * 206264.8 / 0.6345, 2 * 206264.8 / 0.6345)
    named = {cause.id: cause for cause in found.causes}
    assert found.verdict == "named", found.unexplained
    friction = named["friction_hysteresis"]
    # dry friction's loop at T = 0: the twist of 2 F; three deviations of nine draws
    assert abs(friction.magnitude - 2 * friction_Nm * 0.6345) < 3 * friction.magnitude_std
