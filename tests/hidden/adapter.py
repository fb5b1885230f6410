"""The one place that knows the program under test: case in, diagnosis.json out."""

from __future__ import annotations

import tempfile
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexspline.geometry.load import design_from
from hidden.case import Case

if TYPE_CHECKING:
    from flexspline.pipeline.diagnosis.diagnose import Diagnosis


def diagnose(case: Case) -> dict:
    """`flexspline diagnose` without the command line: the same file, the same record.

    `again` : (n,) how far each row of the second measurement is from what the extended model predicts, in the
    deviations that it states; of what was named only.
    """
    from flexspline.pipeline.diagnosis.diagnose import diagnose_measurement
    from flexspline.pipeline.diagnosis.measurement.record import read_measurement
    from flexspline.pipeline.stiffness_pair import StiffnessPair
    from flexspline.results.diagnosis.record import diagnosis_record

    with tempfile.TemporaryDirectory() as folder:
        csv = Path(folder) / "measured.csv"
        csv.write_text(case.csv, encoding="utf-8")
        design, measurement = design_from(tomllib.loads(case.design)), read_measurement(csv)
        found = diagnose_measurement(design, measurement, StiffnessPair(case.K_b, case.K_e))
        record = diagnosis_record(found)
        if found.verdict == "named" and case.again:
            csv.write_text(case.again, encoding="utf-8")
            record["again"] = _off(found, csv)
        return record


def _off(found: Diagnosis, csv: Path) -> np.ndarray:
    """(n,) of a record measured again, in stated deviations."""
    from flexspline.pipeline.diagnosis.measurement.record import read_measurement
    from flexspline.pipeline.diagnosis.model.doubt import deviation_of
    from flexspline.pipeline.diagnosis.sweep.evidence.prepare import true_history

    sweep = read_measurement(csv)
    history = true_history(sweep)
    doubt = found.sweep.doubt
    std = deviation_of(found.model, doubt, history, sweep.units).std_arcsec
    return np.abs(sweep.angle_arcsec - found.model.angle_of(history, sweep.units)) / std
