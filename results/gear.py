"""`flexspline gear`: gear.json, torque_angle.csv and the two charts of the whole gear."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

from flexspline.geometry.design import Design
from flexspline.geometry.sanity import warnings
from flexspline.pipeline.gear.gear_curve import GearCurve
from flexspline.pipeline.stiffnesses import Stiffnesses
from flexspline.pipeline.temporary_files import scratch_folder
from flexspline.results.atomic import write_together
from flexspline.results.figures.gear_loads import write_gear_loads
from flexspline.results.figures.gear_torque_angle import write_gear_angle
from flexspline.results.file_names import CURVE, GEAR_CSV, GEAR_RECORD, LOADS
from flexspline.results.gear_words import gear_warnings
from flexspline.results.records import as_json, gear_figures, heading
from flexspline.results.warned import shortfalls


def gear_record(
    design: Design, curve: GearCurve, shaft: Stiffnesses, wall_s: float
) -> dict[str, Any]:
    """The keys of docs/contract.md; `shaft`: how K_e was found."""
    return {
        **heading(design),
        **gear_figures(curve),
        "wall_s": round(wall_s, 3),
        "warnings": [*warnings(design), *gear_warnings(curve), *shortfalls(design, shaft)],
    }


def write_gear(folder: Path, curve: GearCurve, record: dict[str, Any]) -> list[Path]:
    """The loop as CSV, one row for each torque in the order in which it is passed, the charts and the record.

    All together: a command that is stopped leaves none of them.

    Raises
    ------
    OSError
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("torque_Nm", "angle_arcsec"))
    for torque, angle in zip(curve.torque_Nm, curve.angle_arcsec, strict=True):
        writer.writerow((f"{torque:.9g}", f"{angle:.9g}"))
    made = {GEAR_CSV: text.getvalue().encode()}
    with scratch_folder("flexspline-gear-") as scratch:
        for name, draw in ((CURVE, write_gear_angle), (LOADS, write_gear_loads)):
            picture = scratch / f"{name}.png"
            draw(picture, curve)
            made[picture.name] = picture.read_bytes()
    made[GEAR_RECORD] = (as_json(record) + "\n").encode()
    return write_together(folder, made)
