"""Records that others measured: what the program says of them (docs/real-records.md)."""

from __future__ import annotations

import csv
from pathlib import Path

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import diagnose_file
from flexspline.pipeline.diagnosis.sweep.slip import slip_of

HERE = Path(__file__).parent
CUP = HERE.parents[1] / "examples" / "xb1-40.toml"
N_PER_KIP, MM_PER_IN, ARM_MM = 4448.2216, 25.4, 100.0
"""A damper that is pushed turns an arm of 100 mm: N and mm become N·m and rad."""


def as_torque_sweep(path: Path, folder: Path) -> Path:
    """Time, torque and angle of the damper's record."""
    with path.open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
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
    assert "slips" in found.outcome.unexplained[0].what
    assert found.sweep is not None
    sweep = found.sweep.explained.prepared.sweep
    slip = slip_of(sweep.history, sweep.angle_arcsec)
    assert slip is not None
    # the peak-to-peak way in seven cycles of growing and falling amplitude: at most 77 mm
    assert 20 / ARM_MM < slip.way_arcsec / 206_265 < 77 / ARM_MM
