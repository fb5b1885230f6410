"""A measured file held against a design whose stiffnesses are known: no solver is asked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from flexspline.geometry.design import Design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis, diagnose_measurement
from flexspline.pipeline.diagnosis.measurement.record import read_measurement
from flexspline.pipeline.stiffness_pair import StiffnessPair

if TYPE_CHECKING:
    from flexspline.pipeline.gear.gear_chain import Chain


def diagnose_file(
    design: Design,
    csv: Path,
    K_b: float,
    K_e: float,
    chain: Chain | None = None,
    given: tuple[str, ...] = (),
) -> Diagnosis:
    """Stiffnesses in N·m/rad; otherwise as `diagnose_measurement`."""
    measurement = read_measurement(csv)
    return diagnose_measurement(
        design, measurement, StiffnessPair(K_b, K_e), chain=chain, given=given
    )
