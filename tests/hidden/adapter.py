"""The one place that knows the program under test: case in, diagnosis.json out."""

from __future__ import annotations

import tempfile
import tomllib
from pathlib import Path

from flexspline.geometry.load import design_from
from hidden.case import Case


def diagnose(case: Case) -> dict:
    """`flexspline diagnose` without the command line: the same file, the same record."""
    from flexspline.pipeline.diagnosis.diagnose import diagnose_file
    from flexspline.results.diagnosis.record import diagnosis_record

    with tempfile.TemporaryDirectory() as folder:
        csv = Path(folder) / "measured.csv"
        csv.write_text(case.csv, encoding="utf-8")
        found = diagnose_file(design_from(tomllib.loads(case.design)), csv, case.K_b, case.K_e)
        return diagnosis_record(found)
