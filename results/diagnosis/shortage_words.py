"""Why a measurement is not sufficient, in words."""

from __future__ import annotations

from typing import assert_never

from flexspline.pipeline.diagnosis.shortage import (
    ConstantTorque,
    Drowned,
    FewRows,
    FewSpecimens,
    FewTorques,
    LeapingAngle,
    Shortage,
)
from flexspline.results.numbers import figures_text


def shortage_words(shortage: Shortage) -> str:
    """A clause."""
    match shortage:
        case ConstantTorque():
            return "the torque is constant, so neither stiffness nor gap can be determined"
        case FewTorques():
            return f"fewer than {shortage.wanted} different torques"
        case FewRows(count, wanted):
            beyond = f"only {count} rows lie outside the gap's crossing and the torque's reversals"
            return f"{beyond}; {wanted} are needed"
        case FewSpecimens(count, wanted):
            some = f"{count} specimen{'s' if count != 1 else ''}"
            return f"{some}; modulus, one cause and the noise need {wanted}"
        case Drowned(noise, twist):
            return (
                f"the noise of one reading, {noise:.3g} arcsec, exceeds the simulated twist, "
                f"{twist:.3g} arcsec"
            )
        case LeapingAngle():
            return _leaping(shortage)
        case _:
            assert_never(shortage)


def _leaping(shortage: LeapingAngle) -> str:
    leaps = shortage.leaps
    (least, most), (low, high) = leaps.sizes_arcsec, leaps.torques_Nm
    where = f"{low:.3g} to {high:.3g}".replace("-", "−")
    usual = figures_text(leaps.usual_arcsec, 2)
    return (
        f"the angle jumps {leaps.count} times while the torque changes, by {least:.0f} to {most:.0f} arcsec "
        f"at {where} N·m, and otherwise by {usual} arcsec from row to row: this indicates stick-slip; "
        f"the simulated twist is {shortage.twist_arcsec:.0f} arcsec"
    )
