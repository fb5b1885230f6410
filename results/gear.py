"""`flexspline gear`: gear.json, torque_angle.csv and the two charts of the whole gear."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

from flexspline.geometry.design import Design
from flexspline.geometry.sanity import warnings
from flexspline.pipeline.gear import GearCurve
from flexspline.results.atomic import write_bytes
from flexspline.results.figures.gear import write_gear_angle, write_gear_loads
from flexspline.results.records import heading

FIGURES = (
    "K1_Nm_per_rad", "K2_Nm_per_rad", "K3_Nm_per_rad", "T1_Nm", "T2_Nm", "rated_torque_Nm",
    "lost_motion_arcsec", "teeth_in_contact",
)  # fmt: skip
"""Of the record, by their names in `GearCurve`."""
RECORD = "gear.json"
"""The folder may hold the result.json of a run of the same design."""
CSV, CURVE_CHART, LOAD_CHART = "torque_angle.csv", "gear_torque_angle.png", "gear_loads.png"


def gear_record(design: Design, curve: GearCurve, wall_s: float) -> dict[str, Any]:
    """The keys of docs/contract.md; no friction is modelled, so there is no hysteresis loss."""
    return {
        **heading(design),
        **{key: getattr(curve, key) for key in FIGURES},
        "compliance_shares": dict(curve.compliance_shares),
        "assumed": [{"key": a.key, "value": a.value, "why": a.why} for a in curve.assumed],
        "wall_s": round(wall_s, 3),
        "warnings": [*warnings(design), *curve.warnings],
    }


def write_gear(folder: Path, curve: GearCurve) -> None:
    """The loop as CSV, one row for each torque in the order in which it is passed, and the charts.

    Raises
    ------
    OSError
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("torque_Nm", "angle_arcsec"))
    for torque, angle in zip(curve.torque_Nm, curve.angle_arcsec, strict=True):
        writer.writerow((f"{torque:.9g}", f"{angle:.9g}"))
    write_bytes(folder / CSV, text.getvalue().encode())
    write_gear_angle(folder / CURVE_CHART, curve)
    write_gear_loads(folder / LOAD_CHART, curve)
