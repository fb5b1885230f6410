"""Each warning and note of the whole gear in words, with its figures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import get_args

import pytest
from hand_made_curve import gear_curve

from flexspline.pipeline.cache import Cache
from flexspline.pipeline.gear.gear_remarks import (
    BucklingTube,
    CuttingFlanks,
    EarlyEnd,
    FallingStiffness,
    GearNote,
    GearWarning,
    HalvedBalls,
    JointClearances,
    LoadBeyondRated,
    LoadedLastPair,
    LowRatio,
    LowRim,
    PressingFlanks,
    RelievedFlanks,
    ShapedFaces,
    StraightFlanks,
    TightFlanks,
    TwoTorques,
    WrongStroke,
)
from flexspline.results.gear_words import gear_notes, gear_warnings

WARNINGS: dict[GearWarning, str] = {
    PressingFlanks(
        231.0, WrongStroke(0.13, 0.2)
    ): "up to 230 N each: the plug's stroke of 0.13 mm is not m(z2 - z1)/2 = 0.2 mm",
    PressingFlanks(
        12.34, LowRim(0.05, 0.2)
    ): "up to 12 N each: half the play, 0.05 mm, reduces the rim's stroke of 0.2 mm",
    PressingFlanks(5.0, "flanks_cut"): "up to 5 N each: the flanks interfere",
    PressingFlanks(
        25.0, TightFlanks(54.2, 12.0)
    ): "front flanks press at 54°, back flanks at 12° from the major axis",
    CuttingFlanks(
        "plain", 52.6, 4.04, 55.0, None
    ): "interfere at 53° and more from the major axis, by up to 4 µm at 55°: use the relieved shape or more "
    "clearance",
    CuttingFlanks(
        "drawn", 30.0, 4.0, 55.0, 0.1
    ): "more clearance, or make the working depth less than 0.1 mm",
    LoadBeyondRated(5000.0, 900.0): "load.torque_Nm = 5000 is 5.56 times the rated torque",
    EarlyEnd(
        "ratchets", 1043.0, 2300.0
    ): "the gear ratchets at about 1000 N·m, below the rated torque of 2300 N·m",
    EarlyEnd("buckles", 788.0, 900.0): "the flexspline's tube buckles at about 790 N·m, below",
    "play_closes_gap": "reduce the play",
}
NOTES: dict[GearNote, str] = {
    FallingStiffness("K2", "K1", 0.082, 87.4): (
        "K2 is 8.2 % below K1: this gear becomes softer at larger torque, but gears in catalogues "
        "become stiffer. Here both flanks press without torque"
    ),
    FallingStiffness("K3", "K2", 0.3, 0.0): "K3 is 30 % below K2",
    HalvedBalls(23, 24): "24 balls instead of 23",
    LowRatio(45): "below a ratio of 45 the model is too stiff",
    RelievedFlanks(35.3, 14.6, 54.0): "beyond 35° from the major axis",
    ShapedFaces(16.4): "up to 16 µm at the ends",
    StraightFlanks(20.0): "straight flanks of 20°, not for the drawn flanks",
    LoadedLastPair(54.0): "54° from the major axis, carries a large force",
    TwoTorques(
        0.5, 0.8
    ): "at load.torque_Nm = 0.5, the lost motion at 0.8 N·m (4 % of rated torque)",
    JointClearances(
        24.1, 7.04
    ): "decreases by 24 arcsec; the terms remove the flank clearance first, so the term of the play "
    "is 7 arcsec",
    BucklingTube(
        788.0, 832.0
    ): "at about 790 N·m (lower bound of tests), where its shear stress is 830 MPa",
    "play_beside_stroke": "use the terms bearing_play and tight_gear only together",
    "tube_yields_first": "the flexspline's tube is short or thick: it yields before it buckles",
    "tube_buckles_first": "the flexspline's tube buckles before the gear ratchets",
    "both_limits_alike": "equal only because both are rounded to two digits",
    "no_ratcheting": "no torque was found at which the gear ratchets",
    "ratcheting_is_upper": "the ratcheting torque is an upper limit",
}
CURVE = replace(gear_curve(10.0, 60.0, 5.0), warnings=tuple(WARNINGS), notes=tuple(NOTES))


def test_each_is_said_with_its_figures() -> None:
    for found, said in ((gear_warnings(CURVE), WARNINGS), (gear_notes(CURVE), NOTES)):
        for line, part in zip(found, said.values(), strict=True):
            assert part in line


@pytest.mark.parametrize(("kind", "tried"), [(GearWarning, WARNINGS), (GearNote, NOTES)])
def test_every_kind_is_tried(kind: object, tried: dict) -> None:
    named = {name for each in get_args(kind) for name in get_args(each)}
    classes = {each for each in get_args(kind) if isinstance(each, type)}
    assert {t for t in tried if isinstance(t, str)} == named
    assert {type(t) for t in tried if not isinstance(t, str)} == classes


def test_facts_are_kept_and_not_words(tmp_path: Path) -> None:
    """A sentence that is reworded is said again of a stored curve."""
    Cache(tmp_path).get("gear", {}, lambda: CURVE)
    found, _ = Cache(tmp_path).get("gear", {}, lambda: gear_curve(1.0, 1.0, 1.0))
    assert found == CURVE
