"""The error on data held out: of which rows it is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from histories import PREDICTION, joined, sweep

from flexspline.pipeline.diagnosis.left_out import LeftOut
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Sweep, read_measurement
from flexspline.pipeline.diagnosis.measurement.thinning import thinned
from flexspline.pipeline.diagnosis.outcome import Gain
from flexspline.pipeline.diagnosis.structure import MissedLevel
from flexspline.pipeline.diagnosis.sweep.diagnose import diagnose_sweep
from flexspline.pipeline.diagnosis.sweep.evidence.prepare import prepare
from flexspline.pipeline.diagnosis.sweep.held_out import gains_of, refuted
from flexspline.pipeline.diagnosis.sweep.held_out_splits import (
    Split,
    affordable,
    between_others,
    whole_levels,
)
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep, run_race
from flexspline.pipeline.diagnosis.sweep.row_selection import settling
from flexspline.results.diagnosis.channels import left_out_words

NOISE_ARCSEC = 0.5
CROSSED_OVER = 0.02
"""N·m over which the teeth go from flank to flank: 1 % of the largest torque, the band is 3.5 %."""


def test_rows_in_the_gap_s_crossing_are_left_out() -> None:
    """A gap of 60 arcsec, crossed smoothly: rows on the way are up to 30 arcsec off any sharp gap."""
    history = sweep(cycles=4, hold=0, rows=800)
    rng = np.random.default_rng(8)
    torque = history.torque_Nm
    side = np.tanh(torque / CROSSED_OVER)
    angle = 10.0 * torque + 30.0 * side + rng.normal(0, NOISE_ARCSEC, len(torque))
    record = Sweep(
        Path("rig.csv"), history, angle, ("",), ((1.0, 2.0, 3.0, 4.0),),
        np.arange(len(torque)) + 2, cycles_recorded=True,
    )  # fmt: skip
    outcome, behind = diagnose_sweep(record, PREDICTION)
    assert outcome.gain is not None
    assert behind is not None
    rows = np.array(outcome.gain.held_out_rows)
    assert np.abs(torque[rows]).min() > behind.explained.prepared.band_Nm
    # 370 rows: ± 4 %, three times that
    assert outcome.gain.rmse_after == pytest.approx(NOISE_ARCSEC, rel=0.12)


def softened(
    path: Path, rows: int, cycles: int, wrong: int = 0, first: int = 1
) -> tuple[np.ndarray, np.ndarray]:
    """Triangles to ± 2 N·m with a soft wind-up, as a file: torque and cycle of its rows.

    The `first` cycle has `wrong` single torques of 1e6 N·m.
    """
    turn = np.arange(rows) * cycles / rows
    torque = 2.0 * np.interp(turn % 1, [0, 0.25, 0.75, 1], [0, 1, -1, 0])
    soft = 12.0 * np.sign(torque) * (1 - np.exp(-np.abs(torque) / 0.4))
    noise = np.random.default_rng(4).normal(0, NOISE_ARCSEC, rows)
    angle = 10.0 * torque + 30.0 * np.sign(torque) + soft + noise
    read = torque.copy()
    read[rows // cycles // 4 + 3 * np.arange(wrong)] = 1e6
    columns = zip(np.floor(turn) + first, 0.5 * np.arange(rows), read, angle, strict=True)
    lines = [f"{c:.0f},{t:.1f},{a:.6f},{b:.3f}" for c, t, a, b in columns]
    head = ["# a rig", "cycle,time_s,torque_Nm,angle_arcsec"]
    path.write_text("\n".join([*head, *lines]) + "\n", encoding="utf-8")
    return torque, np.floor(turn) + first


@pytest.mark.parametrize(
    ("rows", "wrong"),
    [*(pytest.param(12_000, n, marks=pytest.mark.long) for n in (0, 30)), (800, 30)],
)
def test_rows_judged_are_those_of_the_file(rows: int, wrong: int, tmp_path: Path) -> None:
    """Where a long record is judged by means, and behind rows that were left out as wrong readings."""
    torque, cycle = softened(tmp_path / "rig.csv", rows, 4, wrong)
    read = read_measurement(tmp_path / "rig.csv")
    assert isinstance(read, Sweep)
    outcome, behind = diagnose_sweep(read, PREDICTION)
    assert [c.id for c in outcome.causes] == ["stiffness_hardening"]
    assert outcome.gain is not None
    assert behind is not None
    judged = np.array(outcome.gain.held_out_rows)
    assert outcome.gain.held_out == LeftOut("cycle", (2.0,))
    assert set(cycle[judged]) == {2.0}
    # all of the cycle, but for two rows, or means, at each turn, and the crossing, 3.5 % of the torque
    assert len(judged) > 0.94 * rows / 4
    assert np.abs(torque[judged]).min() > behind.explained.prepared.band_Nm - 8 * 4 / rows


def split_of(
    history: History, first: tuple[float, ...] = (1.0,), units: tuple[str, ...] = ("",)
) -> Split | None:
    """Where each unit's first cycle has the number `first`, and every row may be judged."""
    own = history.cycle + np.array(first)[history.unit]
    return between_others(history, own, units, np.ones(len(history), bool))


def test_cycles_have_their_own_unit_s_numbers() -> None:
    """Two units, of cycles 11 to 14 and 21 to 26: neither has a cycle 2."""
    four, six = (replace(sweep(cycles=n, hold=0), input_angle_deg=None) for n in (4, 6))
    history = joined_units([four, six])
    split = split_of(history, (11.0, 21.0), ("A", "B"))
    assert split is not None
    assert split.what.of_units == (("A", (12.0,)), ("B", (22.0, 25.0)))
    assert left_out_words(split.what) == "cycle 12 of unit A, cycles 22, 25 of unit B"
    same = split_of(history, (11.0, 11.0), ("A", "B"))
    assert same is not None
    assert left_out_words(same.what) == "cycles 12, 15"


def joined_units(parts: list[History]) -> History:
    """Units one after the other, without a wave generator."""
    units = [replace(p, unit=np.full(len(p), u)) for u, p in enumerate(parts)]
    return History(*(
        np.concatenate([getattr(p, name) for p in units])
        for name in ("torque_Nm", "unit", "cycle", "time_s")
    ))  # fmt: skip


def test_a_unit_has_its_own_name() -> None:
    history = joined_units([sweep(cycles=1, hold=0)] * 3)
    split = split_of(history, (1.0,) * 3, ("gear-07", "gear-12", "gear-31"))
    assert split is not None
    assert split.what == LeftOut("unit", names=("gear-12",))
    assert left_out_words(split.what) == "unit gear-12"
    assert set(history.unit[split.rows]) == {1}


def test_cycles_of_a_shortened_record_keep_their_numbers(tmp_path: Path) -> None:
    """Of 200 cycles from 301 on, some are left out as a whole: what is left is not counted again."""
    softened(tmp_path / "rig.csv", 20_000, 200, first=301)
    read = read_measurement(tmp_path / "rig.csv")
    assert isinstance(read, Sweep)
    short = thinned(read)
    assert len(np.unique(short.history.cycle)) < 200
    judged = np.ones(len(short), bool)
    split = between_others(short.history, short.own_cycle, short.units, judged)
    assert split is not None
    assert min(split.what.values) > 301
    rows = short.file_rows(split.rows)
    assert set(rows // 100 + 301) == set(split.what.values)


def test_many_cycles_held_out_are_counted_and_not_all_listed() -> None:
    history = sweep(cycles=30, hold=0, rows=1200)
    split = split_of(history)
    assert split is not None
    assert left_out_words(split.what) == "cycles 2, 5, 8, … 29 (10 cycles)"
    eight = sweep(cycles=8, hold=0, rows=800)
    few = split_of(eight)
    assert few is not None
    assert few.what == LeftOut("cycle", (2.0, 5.0))


def levels(amplitudes: tuple[float, ...], seconds: tuple[float, ...]) -> History:
    """Cycles of triangles to ± 2 N·m times each amplitude, 5 K warmer every second cycle."""
    one = sweep(cycles=1, hold=0, rows=200)
    start, parts = 0.0, []
    for k, (amplitude, step) in enumerate(zip(amplitudes, seconds, strict=True)):
        t = start + step * np.arange(1, len(one) + 1)
        start = t[-1]
        parts.append(
            replace(
                one, torque_Nm=amplitude * one.torque_Nm, time_s=t, cycle=np.full(len(t), k),
                temperature_C=np.full(len(t), 20.0 + 5.0 * (k % 2)),
            )
        )  # fmt: skip
    return joined(parts)


def test_cycles_before_the_first_large_turn_are_not_held_out() -> None:
    """Amplitudes that rise: nobody knows what friction remembers there, so nothing is judged in them."""
    rising = levels((0.2, 0.4, 0.7, 1.0, 0.2, 0.4, 0.7, 1.0), (1.0,) * 8)
    judged = ~settling(rising)
    assert not judged[rising.cycle == 1].any()  # the second cycle, which else is the first held out
    split = between_others(rising, rising.cycle + 1.0, ("",), judged)
    assert split is not None
    assert all(judged[rising.cycle == number - 1].any() for number in split.what.values)
    assert split.rows.any()


def test_each_amplitude_rate_and_temperature_is_held_out_as_a_whole() -> None:
    history = levels((1.0, 0.5, 1.0, 0.25), (1.0, 2.0, 4.0, 1.0))
    found = {
        (s.what.channel, left_out_words(s.what)): set(history.cycle[s.rows])
        for s in whole_levels(history, True)
    }
    # 0.04 N·m a second at full amplitude and a row a second; rates: 0.04, 0.01, 0.01, 0.01
    assert found == {
        ("torque_amplitude", "amplitude 0.5 N·m"): {3},
        ("torque_amplitude", "amplitude 1 N·m"): {1},
        ("torque_amplitude", "amplitude 2 N·m"): {0, 2},
        ("torque_rate", "rate 0.01 N·m/s"): {1, 2, 3},
        ("torque_rate", "rate 0.04 N·m/s"): {0},
        # 20 °C would be the cycles of amplitude 2 again
        ("temperature_C", "temperature 25.0 °C"): {1, 3},
    }


def test_a_record_of_one_amplitude_rate_and_temperature_has_no_levels() -> None:
    history = replace(sweep(cycles=4, hold=0, rows=200), temperature_C=None)
    assert whole_levels(history, True) == []


def test_a_long_record_spares_the_ends_of_a_channel_or_none_of_it() -> None:
    """One end that is judged alone says nothing (`refuted`), and takes a search's time."""
    history = levels((1.0, 0.5, 0.25, 1.0, 0.5, 0.25), (1.0, 1.0, 1.0, 16.0, 4.0, 4.0))
    every = whole_levels(history, True)
    channels = [s.what.channel for s in every]
    assert channels == ["torque_amplitude"] * 3 + ["torque_rate"] * 3 + ["temperature_C"] * 2
    ends = {"torque_amplitude": [0, 2], "torque_rate": [3, 5], "temperature_C": [6, 7]}
    for most, chosen in (
        (0, []),
        (1, []),
        (2, ends["temperature_C"]),
        (3, ends["temperature_C"]),
        (4, ends["torque_rate"] + ends["temperature_C"]),
        (5, [3, 4, 5, 6, 7]),
        (6, [0, 2, 3, 5, 6, 7]),
        (8, list(range(8))),
        (99, list(range(8))),
    ):
        assert [s.what for s in affordable(every, most)] == [every[i].what for i in chosen]
    single = every[:7]
    assert [s.what for s in affordable(single, 4)] == [every[i].what for i in (0, 2, 3, 5)]
    assert [s.what for s in affordable(single, 5)] == [every[i].what for i in (0, 2, 3, 5, 6)]


def test_a_unit_keeps_the_level_that_is_all_it_has() -> None:
    """Its zero would else not be known."""
    one = levels((1.0, 0.5), (1.0, 2.0))
    only = levels((0.5,), (2.0,))
    history = joined([one, replace(only, unit=np.ones(len(only), int))])
    small = next(
        s
        for s in whole_levels(history, True)
        if s.what == LeftOut("torque_amplitude", (1.0, 1.0), level=True)
    )
    assert set(history.unit[small.rows]) == {0}


def explained(history: History, angle: np.ndarray) -> ExplainedSweep:
    record = Sweep(
        Path("rig.csv"), history, angle, ("",), (tuple(np.unique(history.cycle) + 1.0),),
        np.arange(len(angle)) + 2, cycles_recorded=True,
    )  # fmt: skip
    return run_race(prepare(record, PREDICTION))


def test_a_level_held_out_teaches_nothing() -> None:
    """Its readings moved by 40 arcsec, its errors move by just that: nothing that predicts has seen them."""
    history = levels((1.0, 0.5, 1.0, 0.5), (1.0, 1.0, 1.0, 1.0))
    history = replace(history, temperature_C=None)
    rng = np.random.default_rng(4)
    share = np.abs(history.torque_Nm) / 2.0
    soft = 12.0 * np.sign(history.torque_Nm) * (1 - np.exp(-share / 0.2))  # a soft wind-up
    angle = 10.0 * history.torque_Nm + 30.0 * history.sign + soft + rng.normal(0, 0.5, len(share))
    raced = explained(history, angle)
    assert raced.identified.named == ("stiffness_hardening",)
    for level in gains_of(raced, raced.identified.named)[1]:
        rows = np.array(level.held_out_rows)
        prepared = raced.prepared
        moved = prepared.target.copy()
        moved[np.isin(history.cycle, np.unique(history.cycle[rows]))] += 40.0
        other = replace(raced, prepared=replace(prepared, target=moved))
        again = next(
            g for g in gains_of(other, raced.identified.named)[1] if g.held_out == level.held_out
        )
        assert again.left["after"] == pytest.approx(level.left["after"] + 40.0, abs=1e-6)
    fresh = prepare(raced.prepared.sweep, PREDICTION).columns.terms
    untuned = raced.prepared.columns.untuned.terms
    assert [(t.owner, t.shape) for t in untuned] == [(t.owner, t.shape) for t in fresh]
    assert len(raced.prepared.columns.terms) > len(untuned)


def test_what_is_known_carries_over_to_an_amplitude_not_measured() -> None:
    """Friction of one threshold, 0.1 N·m, 2 · 6 arcsec wide: the same loop at any larger amplitude."""
    history = replace(levels((1.0, 0.5, 1.0, 0.5), (1.0,) * 4), temperature_C=None)
    torque, state = history.torque_Nm, np.zeros(len(history))
    for k in range(1, len(state)):
        state[k] = np.clip(state[k - 1] + torque[k] - torque[k - 1], -0.1, 0.1)
    rng = np.random.default_rng(5)
    angle = 10.0 * torque + 30.0 * history.sign - 60.0 * state + rng.normal(0, 0.5, len(torque))
    raced = explained(history, angle)
    gains = gains_of(raced, ("friction_hysteresis",))[1]
    assert {left_out_words(g.held_out) for g in gains} == {"amplitude 1 N·m", "amplitude 2 N·m"}
    for g in gains:  # 300 rows and more: the rms of the noise is good to 4 %, three times that
        assert g.rmse_after == pytest.approx(0.5, rel=0.15)
        assert g.rmse_before > 4.0  # 6 arcsec beside the line on all but the reversals


RATE = LeftOut("torque_rate", (0.1, 0.1), level=True)


def test_causes_that_double_the_error_of_a_level_explain_nothing() -> None:
    def level(
        calibrated: float, after: float, stated: float = 0.0, elsewhere: bool = False
    ) -> Gain:
        return Gain(RATE, 9.0, calibrated, after, 0.5, stated_std=stated, elsewhere=elsewhere)

    assert refuted([]) is None
    assert refuted([level(4.0, 1.0), level(1.0, 1.9)]) is None
    # what only the level held out tells may be missed by as much as was said
    assert refuted([level(1.0, 2.1, stated=0.8)]) is None
    # as positions of the wave generator that went with it
    assert refuted([level(1.0, 5.0, elsewhere=True)]) is None
    # and at a level that is left alone, or one of two, which alone may show a shape
    assert refuted([level(1.0, 5.0)]) is None
    assert refuted([level(4.0, 1.0), level(1.0, 2.1)]) is None
    found = refuted([level(4.0, 1.0), level(1.0, 2.1, stated=0.6), level(1.0, 2.05)])
    assert found is not None
    assert found.channel == "torque_rate"
    assert found.structure == MissedLevel(RATE, 2.1, 1.0)
    assert found.limit


APART_DEG = 360.0 / 9


@pytest.mark.parametrize(
    ("places", "elsewhere"),
    [
        (APART_DEG * np.arange(9), True),
        (np.zeros(9), False),
        # those held out lie 0.2° and 2° from others, across 2.5° and 360°; then 6° from the nearest
        (np.repeat([0.0, 120.0, 240.0], 3) + np.tile([2.4, 2.4, 2.6], 3), False),
        (np.repeat([0.0, 120.0, 240.0], 3) + np.tile([359.0, 359.0, 361.0], 3), False),
        (np.repeat([0.0, 120.0, 240.0], 3) + np.tile([0.0, 12.0, 6.0], 3), True),
    ],
)
def test_a_level_with_positions_of_its_own_says_where_it_is(
    places: np.ndarray, elsewhere: bool
) -> None:
    """Nine cycles, every third to half the torque; a wave generator locked again for each, or never."""
    history = replace(levels((1.0, 1.0, 0.5) * 3, (1.0,) * 9), temperature_C=None)
    place = places[history.cycle]
    history = replace(history, input_angle_deg=place)
    rng = np.random.default_rng(6)
    angle = 10.0 * history.torque_Nm + 30.0 * history.sign + 3.0 * np.sin(np.radians(place))
    raced = explained(history, angle + rng.normal(0, 0.5, len(angle)))
    gains = gains_of(raced, ("kinematic_error",))[1]
    assert len(gains) == 2
    # the level of the other six cycles is held out too: what is near for one is near for both
    assert [g.elsewhere for g in gains] == [elsewhere, elsewhere]
    assert not any(g.elsewhere for g in gains_of(raced, ("friction_hysteresis",))[1])
