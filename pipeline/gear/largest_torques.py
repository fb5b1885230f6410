"""Torque limits of the whole gear: buckling of the flexspline's tube, and ratcheting of the teeth."""

from __future__ import annotations

from flexspline.fea.gear.tube_buckling import Tube
from flexspline.fea.types import Elastic
from flexspline.geometry.design import Design
from flexspline.pipeline.gear.gear_remarks import BucklingTube, EarlyEnd, GearNote, GearWarning


def tube_of(design: Design) -> Tube | None:
    """Return the thin wall between diaphragm and ring; None where there is none."""
    return Tube.between(design.flexspline, Elastic.of(design.material.flexspline))


def largest_torques(
    engaged_Nm: float | None, tube: Tube | None, rated_Nm: float
) -> tuple[list[GearWarning], list[GearNote]]:
    """Return warnings and notes; `engaged_Nm`: the ratcheting torque. Catalogues': docs/whole-gear.md."""
    warned: list[GearWarning] = []
    noted: list[GearNote] = ["no_ratcheting" if engaged_Nm is None else "ratcheting_is_upper"]
    if engaged_Nm is not None and engaged_Nm < rated_Nm:
        warned.append(EarlyEnd("ratchets", engaged_Nm, rated_Nm))
    if tube is not None and tube.yields_first:
        noted.append("tube_yields_first")
    elif tube is not None:
        buckles = tube.lower_edge_Nm
        if buckles < rated_Nm:
            warned.append(EarlyEnd("buckles", buckles, rated_Nm))
        noted.append(BucklingTube(buckles, tube.stress_MPa(buckles)))
        if engaged_Nm is not None and two_digits(buckles) < two_digits(engaged_Nm):
            noted.append("tube_buckles_first")
        elif engaged_Nm is not None and two_digits(buckles) == two_digits(engaged_Nm):
            noted.append("both_limits_alike")
    return warned, noted


def buckling_torque(tube: Tube | None) -> float | None:
    """Return the estimate [N·m], two digits; None without a tube, or where it yields first."""
    return None if tube is None or tube.yields_first else two_digits(tube.lower_edge_Nm)


def two_digits(value: float) -> float:
    """Return an estimate rounded to two digits."""
    return float(f"{value:.2g}")
