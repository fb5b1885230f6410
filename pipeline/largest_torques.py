"""How much torque the whole gear takes: its flexspline's tube buckles, its teeth are pressed out."""

from __future__ import annotations

from flexspline.fea.gear.tube_buckling import Tube
from flexspline.fea.types import Elastic
from flexspline.geometry.design import Design


def tube_of(design: Design) -> Tube | None:
    """The thin wall between diaphragm and ring; None where there is none."""
    return Tube.between(design.flexspline, Elastic.of(design.material.flexspline))


def largest_torques(
    engaged_Nm: float | None, tube: Tube | None, rated_Nm: float
) -> tuple[list[str], list[str]]:
    """Warnings and notes; `engaged_Nm`: the ratcheting torque. Catalogues': docs/whole-gear.md."""
    warned, noted = [], []
    if engaged_Nm is None:
        noted.append("no torque was found at which the gear ratchets")
    else:
        if engaged_Nm < rated_Nm:
            warned.append(
                f"the gear ratchets at some {rounded(engaged_Nm)} N·m, below the rated torque of "
                f"{rated_Nm:.4g} N·m"
            )
        noted.append(
            "the ratcheting torque is an upper limit: only elastic parts yield in it; catalogues' gears "
            "ratchet at a fiftieth (ratio 30) to a fifth (ratio 160) of it, and at 0.3 to 0.8 of the torque "
            "at which they buckle"
        )
    if tube is not None:
        buckles = tube.lower_edge_Nm
        if buckles < rated_Nm:
            warned.append(
                f"the flexspline's tube buckles at some {rounded(buckles)} N·m, below the rated torque of "
                f"{rated_Nm:.4g} N·m"
            )
        noted.append(
            f"the flexspline's tube buckles at some {rounded(buckles)} N·m, the lower edge of tests, at a "
            f"shear stress of {rounded(tube.stress_MPa(buckles))} MPa; a wall whose yield stress is "
            "lower fails earlier"
        )
    return warned, noted


def rounded(value: float) -> str:
    """Two digits, for a reader."""
    return f"{two_digits(value):g}"


def two_digits(value: float) -> float:
    """Of an estimate."""
    return float(f"{value:.2g}")
