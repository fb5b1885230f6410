"""Names of the files that each command writes; obstacles are found before the work."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import chain
from typing import Literal

from flexspline.geometry.part_name import PART_NAMES

RESULT = "result.json"
"""Record of `run`, `stiffness` and `backlash`."""
PREVIOUS = "result.previous.json"
"""An earlier result.json with figures that the present one lacks."""
REPORT = "report"
"""Name of the reports of a run and of a study."""
ELLIPSE = "wave_generator"
RENDERED = (*(f"{part}_{what}" for part in PART_NAMES for what in ("mesh", "torque")), ELLIPSE)
"""Pictures of a run that VTK draws."""
CURVE, LOADS = "gear_torque_angle", "gear_loads"
"""Charts of `gear` and of a run."""
ChartSection = Literal["budget", "gear", "solver"]
CHARTS_OF: Mapping[ChartSection, tuple[str, ...]] = {
    "budget": ("backlash_budget", "torque_angle"),
    "gear": (CURVE, LOADS),
    "solver": ("convergence",),
}
"""Pictures of a run that matplotlib draws, by the section of the report and in their order there;
`figures/NAME.py` draws the one called NAME, and has its caption."""
CHARTS = tuple(chain.from_iterable(CHARTS_OF.values()))
FORMATS = ("msh", "med", "bdf", "inp", "vtu", "xdmf")
"""File suffixes that `export --format` accepts."""
GEAR_RECORD, GEAR_CSV = "gear.json", "torque_angle.csv"
"""Separate names, because the folder may hold the result.json of a run of the same design."""
DIAGNOSIS = "diagnosis"
"""Name of the record and the reports of a diagnosis: the folder may hold `report.pdf` of a run of the same
design."""
EXTENDED_MODEL, PREVIOUS_MODEL = "extended_model.toml", "extended_model.previous.toml"
"""The model of this measurement, and the model of an earlier one whose diagnosis was in the folder."""
PREDICTION = "prediction.csv"
BEST_DESIGN, BEST_STRESS = "best.toml", "best_stress.png"
SENSITIVITY = "sensitivity.json"


def _pictures(*names: str) -> tuple[str, ...]:
    return tuple(f"{name}.png" for name in names)


def _reports(name: str) -> tuple[str, ...]:
    return f"{name}.pdf", f"{name}.html"


ONE_RECORD = (RESULT, PREVIOUS)
RUN = (*ONE_RECORD, *_reports(REPORT), *_pictures(*RENDERED, *CHARTS))
GEAR = (GEAR_RECORD, GEAR_CSV, *_pictures(CURVE, LOADS))
STUDY = (
    "study.db", "study.csv", "study.parquet", BEST_DESIGN, BEST_STRESS, *_reports(REPORT),
    *_pictures("pareto", "best", "parallel", "sweep", "convergence", "tolerance"),
)  # fmt: skip


def of_diagnosis(figures: Iterable[str]) -> tuple[str, ...]:
    """`figures`: names of all that a diagnosis may have."""
    record = f"{DIAGNOSIS}.json"
    return record, EXTENDED_MODEL, PREVIOUS_MODEL, *_reports(DIAGNOSIS), *_pictures(*figures)


def of_export(formats: Iterable[str], deck: bool) -> tuple[str, ...]:
    """Of `export` with these `--format`s, and with or without `--deck`."""
    endings = [".step", ".stl", "_torque.vtu", *(f".{suffix}" for suffix in formats)]
    endings += ["_torsion.inp"] * deck
    return (*(part + ending for part in PART_NAMES for ending in endings), f"{ELLIPSE}.vtu")
