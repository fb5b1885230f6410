"""What `flexspline diagnose` does: stiffnesses, diagnosis, files, words."""

from __future__ import annotations

from pathlib import Path

from flexspline.pipeline.chain import Stiffnesses as Solved
from flexspline.pipeline.chain import stiffnesses
from flexspline.pipeline.diagnosis.diagnose import diagnose_file
from flexspline.pipeline.diagnosis.record import read_measurement
from flexspline.pipeline.parts import Workshop
from flexspline.results.diagnosis.console import diagnosis_table
from flexspline.results.diagnosis.files import write_diagnosis
from flexspline.results.diagnosis.record import diagnosis_record
from flexspline.results.records import as_json
from flexspline.results.report.attached import Attachment
from flexspline.results.report.compared import Stiffnesses


def diagnose_and_write(
    shop: Workshop,
    measured: Path,
    given: tuple[float | None, float | None],
    folder: Path,
    json: bool,
    attached: tuple[Attachment, ...] = (),
) -> str:
    """Diagnose, write all files, and return what is printed; `given` are K_b and K_e, None: FEA.

    Raises
    ------
    DesignError, ComputationError, MeasurementError
    """
    used = _stiffnesses(shop, measured, given)
    with shop.progress.stage("diagnosis"):
        found = diagnose_file(
            shop.design, measured, used.K_b_Nm_per_rad, used.K_e_Nm_per_rad, used.error,
            shop if given == (None, None) else None,
        )  # fmt: skip
    record = diagnosis_record(found)
    with shop.progress.stage("figures and report"):
        write_diagnosis(folder, found, record, used, attached)
    return as_json(record) if json else diagnosis_table(found, folder)


def _stiffnesses(
    shop: Workshop, measured: Path, given: tuple[float | None, float | None]
) -> Stiffnesses:
    K_b, K_e = given
    if K_b is not None and K_e is not None:
        return Stiffnesses(K_b, K_e, True)
    read_measurement(measured)  # refuse a bad file before the long work
    rim = shop.design.solver.load_case == "lobes"
    solved = stiffnesses(shop, flexspline=K_b is None, shaft=K_e is None, rim=rim)
    return _with_errors(shop, solved, K_b, K_e)


def _with_errors(
    shop: Workshop, solved: Solved, K_b: float | None, K_e: float | None
) -> Stiffnesses:
    """Each compliance with the half width of its bounds; a given K has none."""
    compliance = doubt = 0.0
    values = []
    for K, part in ((K_b, "flexspline"), (K_e, "shaft")):
        half = 0.0
        if K is None:
            found = solved.in_sum(shop.design) if part == "flexspline" else solved.shaft
            K = found.K_Nm_per_rad
            half = (1 / found.lower_Nm_per_rad - 1 / found.upper_Nm_per_rad) / 2
        values.append(K)
        compliance += 1 / K
        doubt += half
    return Stiffnesses(values[0], values[1], False, doubt / compliance)
