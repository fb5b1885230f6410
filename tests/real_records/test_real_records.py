"""Records that others measured: what the program says of them (docs/real-records.md)."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path

import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.shortage import LeapingAngle
from flexspline.pipeline.diagnosis.structure import Slip
from flexspline.pipeline.diagnosis.sweep.rig_faults.clamp_slip import slip_of

HERE = Path(__file__).parent
CUP = EXAMPLES / "xb1-40.toml"
N_PER_KIP, MM_PER_IN, ARM_MM = 4448.2216, 25.4, 100.0
"""A damper that is pushed turns an arm of 100 mm: N and mm become N·m and rad."""
ARCSEC_PER_MM = math.degrees(1 / ARM_MM) * 3600
NM_PER_KN = ARM_MM


def rows_of(path: Path) -> list[dict[str, str]]:
    """The rows below the lines of comment."""
    with path.open(encoding="utf-8") as stream:
        return list(csv.DictReader(line for line in stream if not line.startswith("#")))


def as_torque_sweep(path: Path, folder: Path) -> Path:
    """Time, torque and angle of the damper's record."""
    rows = rows_of(path)
    made = folder / "sweep.csv"
    with made.open("w", encoding="utf-8") as out:
        out.write("time_s,torque_Nm,angle_mrad\n")
        for row in rows:
            torque_Nm = float(row["force_kip"]) * N_PER_KIP * ARM_MM / 1000
            angle_mrad = float(row["displacement_in"]) * MM_PER_IN / ARM_MM * 1000
            out.write(f"{row['time_s']},{torque_Nm:.4f},{angle_mrad:.5f}\n")
    return made


def test_a_friction_damper_slips_and_no_cause_is_named(tmp_path: Path) -> None:
    """The belt gives way at 10 kN and the damper travels 68 of its 77 mm there: no gear does that."""
    record = as_torque_sweep(HERE / "arts-damper-0.25Hz-30lb.csv", tmp_path)
    found = diagnose_file(load_design(CUP), record, 50_000.0, 60_000.0)
    assert found.verdict == "unknown"
    assert found.causes == ()
    assert isinstance(found.outcome.unexplained[0].structure, Slip)
    assert found.sweep is not None
    sweep = found.sweep.explained.prepared.sweep
    slip = slip_of(sweep.history, sweep.angle_arcsec)
    assert slip is not None
    # the peak-to-peak way in seven cycles of growing and falling amplitude: at most 77 mm
    assert 20 / ARM_MM < slip.slip_arcsec / 206_265 < 77 / ARM_MM


JOINT = rows_of(HERE / "slotboom-joint-spc1.csv")
FORCE_KN = [float(row["force_kN"]) for row in JOINT]
WAY_MM = [float(row["displacement_mm"]) for row in JOINT]
LAST_REVERSAL = 2230
MIDWAY = 2285
"""Rows of the record up to the joint's last turn, at -2.44 mm, and midway from there to nothing."""
FIRST_LOOP_MM, LATER_LOOPS_MM = 1.33, 0.95
"""Width at no force, read off a plot of force against displacement."""
TIPS_MM, TIPS_KN = 2.44, (9.9, -10.7)
"""Where the four later loops turn, read off the same plot."""


def joint(folder: Path, rows: int, row_s: float | None = None) -> Diagnosis:
    """What the program says of the joint's first rows, on an arm of 100 mm; with a clock, if one is given."""
    made = folder / "sweep.csv"
    with made.open("w", encoding="utf-8") as out:
        out.write(f"{'time_s,' if row_s else ''}torque_Nm,angle_mrad\n")
        for row, (force, way) in enumerate(zip(FORCE_KN[:rows], WAY_MM[:rows], strict=True)):
            clock = f"{row * row_s:.3f}," if row_s else ""
            out.write(f"{clock}{force * NM_PER_KN:.1f},{way / ARM_MM * 1000:.2f}\n")
    return diagnose_file(load_design(CUP), made, 80_000.0, 90_000.0)


def ways_at_no_force(force: list[float], way: list[float]) -> list[float]:
    """The displacement each time the force changes its sign."""
    points = pairwise(zip(force, way, strict=True))
    return [a - f * (b - a) / (g - f) for (f, a), (g, b) in points if f * g < 0]


def named_or_alternative(found: Diagnosis) -> set[str]:
    return {name for cause in found.causes for name in (cause.id, *cause.alternatives)}


def steps(values: Iterable[float]) -> list[float]:
    numbers = list(values)
    return [after - before for before, after in pairwise(numbers)]


def test_the_joint_s_loops_are_as_the_plot_shows() -> None:
    """The first loop is wider, being larger; the later four lie on one another within 0.03 mm."""
    ways = ways_at_no_force(FORCE_KN[150:], WAY_MM[150:])
    widths = [abs(step) for step in steps(ways)]
    assert widths[0] == pytest.approx(FIRST_LOOP_MM, abs=0.02)
    assert widths[2:] == pytest.approx([LATER_LOOPS_MM] * len(widths[2:]), abs=0.03)
    assert max(ways[2::2]) - min(ways[2::2]) < 0.03
    assert max(ways[3::2]) - min(ways[3::2]) < 0.03


@pytest.mark.parametrize(
    "rows",
    [*(pytest.param(n, marks=pytest.mark.long) for n in (LAST_REVERSAL, MIDWAY)), len(JOINT)],
)
def test_a_joint_that_rubs_may_rub_or_lag_when_time_was_not_recorded(
    tmp_path: Path, rows: int
) -> None:
    """One speed and no time: friction and lag cannot be told apart; neither may be ruled out.

    Whether the last way back is kept, in part or not at all, changes nothing that repeats in four loops. The
    tips lie at +9.9 and -10.7 kN: a shift of the torque, if any, is 40 N·m, less than is sought.
    """
    found = joint(tmp_path, rows)
    assert found.verdict == "ambiguous"
    by_name = {cause.id: cause for cause in found.causes}
    assert "friction_hysteresis" in named_or_alternative(found)
    # the loop comes from friction, lag or both: friction that has a size is at most as wide as all of it
    widest_arcsec = FIRST_LOOP_MM * ARCSEC_PER_MM
    assert {"friction_hysteresis", "rate_dependence"} & set(by_name)
    if "friction_hysteresis" in by_name:
        assert 0 < by_name["friction_hysteresis"].magnitude < widest_arcsec
    # five loops that lie on one another: nothing wears or drifts, nothing was lost on the way
    assert named_or_alternative(found).isdisjoint({"wear", "sensor_drift", "torque_offset"})
    assert found.calibration is not None
    assert found.calibration.compliance is not None
    torque_Nm = (TIPS_KN[0] - TIPS_KN[1]) * NM_PER_KN
    by_hand = 2 * TIPS_MM * ARCSEC_PER_MM / torque_Nm
    assert found.calibration.compliance.value == pytest.approx(by_hand, rel=0.05)


@pytest.mark.long  # by default without a clock, which must not tell more: the test above
@pytest.mark.parametrize("rows", [LAST_REVERSAL, len(JOINT)])
def test_a_clock_does_not_tell_what_one_speed_cannot(tmp_path: Path, rows: int) -> None:
    """A row each 0.1 s: whatever the loop is taken for, the other may have made it."""
    found = joint(tmp_path, rows, row_s=0.1)
    assert found.verdict == "ambiguous"
    assert {"friction_hysteresis", "rate_dependence"} <= named_or_alternative(found)
    assert all(c.alternatives for c in found.causes)


def test_a_strain_wave_gear_that_sticks_gives_no_verdict(tmp_path: Path) -> None:
    """Three staircases that only rise: whether a step is friction, play or spring they cannot say."""
    rows = rows_of(HERE / "pravin-strain-wave-lever.csv")
    made = tmp_path / "sweep.csv"
    with made.open("w", encoding="utf-8") as out:
        out.write("unit,torque_Nm,angle_mrad\n")
        for row in rows:
            angle_mrad = math.radians(float(row["drift_deg"])) * 1000
            out.write(f"run {row['run']},{row['moteus_Nm']},{angle_mrad:.4f}\n")
    # between the jumps some 2500 N·m/rad, of which cup and shaft have half each
    found = diagnose_file(load_design(CUP), made, 5_000.0, 5_000.0)
    assert found.verdict == "insufficient"
    assert found.causes == ()
    assert found.outcome.next_measurement is not None
    assert found.outcome.next_measurement.vary == "torque_Nm"
    # five jumps of 0.36 to 0.94°, at 8 to 18 N·m: no noise of a reading that steps by 0.005°
    assert isinstance(found.outcome.too_little, LeapingAngle)
    assert found.outcome.too_little.leaps.count == 5
    assert found.outcome.too_little.leaps.torques_Nm == pytest.approx((8.0, 18.0), abs=0.5)


def test_the_strain_wave_gear_s_way_is_mostly_jumps() -> None:
    """Five jumps of 0.36 to 0.94° are five sixths of the way; between them some 2500 N·m/rad."""
    rows = rows_of(HERE / "pravin-strain-wave-lever.csv")
    jumped_deg = crept_deg = crept_Nm = 0.0
    for run in {row["run"] for row in rows}:
        turned = steps(float(row["drift_deg"]) for row in rows if row["run"] == run)
        loaded = steps(float(row["moteus_Nm"]) for row in rows if row["run"] == run)
        jumped_deg += sum(step for step in turned if step > 0.3)
        crept_deg += sum(step for step in turned if step <= 0.3)
        crept_Nm += sum(load for load, step in zip(loaded, turned, strict=True) if step <= 0.3)
    assert 0.75 < jumped_deg / (jumped_deg + crept_deg) < 0.9
    assert 2000 < crept_Nm / math.radians(crept_deg) < 3000
