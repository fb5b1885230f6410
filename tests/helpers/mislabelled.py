"""Records of tests/hidden, written as a person would who mistakes a unit, a sign or a channel."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from dataclasses import dataclass

from hidden.case import Case

ARCSEC_PER_RAD = math.degrees(3600)
_OURS = {
    "torque_Nmm": ("torque_Nm", 1e-3), "angle_arcmin": ("angle_arcsec", 60.0),
    "angle_deg": ("angle_arcsec", 3600.0), "angle_mrad": ("angle_arcsec", ARCSEC_PER_RAD / 1e3),
}  # fmt: skip


@dataclass(frozen=True)
class Fault:
    """What is done to the numbers of a column, and under which name they are written."""

    column: str
    change: Callable[[float], float]
    name: str


def _angle(per_arcsec: float, name: str) -> Fault:
    return Fault("angle_arcsec", lambda v: v * per_arcsec, name)


def _torque(per_Nm: float, name: str) -> Fault:
    return Fault("torque_Nm", lambda v: v * per_Nm, name)


def counts(bits: int, name: str) -> Fault:
    """An encoder of so many bits a turn."""
    return Fault("angle_arcsec", lambda v: round(v * 2**bits / 1_296_000), name)


def mislabelled(case: Case, fault: Fault) -> str:
    """The case's file with a fault."""
    head, *rows = csv.reader(s for s in case.csv.splitlines() if not s.startswith("#"))
    ours = [_OURS.get(name, (name, 1.0)) for name in head]
    at = [name for name, _ in ours].index(fault.column)
    names = [fault.name if i == at else name for i, (name, _) in enumerate(ours)]
    lines = [",".join(names)]
    for row in rows:
        values = [t if f == 1 else repr(float(t) * f) for t, (_, f) in zip(row, ours, strict=True)]
        values[at] = repr(fault.change(float(values[at])))
        lines.append(",".join(values))
    return "\n".join(lines) + "\n"


NONE = _angle(1.0, "angle_arcsec")
ABSURD: dict[str, tuple[Fault, str]] = {
    "counts, 17 bits, as degrees": (counts(17, "angle_deg"), "--counts-per-turn N"),
    "counts, 20 bits, as degrees": (counts(20, "angle_deg"), "--counts-per-turn N"),
    "counts, 24 bits, as degrees": (counts(24, "angle_deg"), "--counts-per-turn N"),
    "angle turned": (_angle(-1, "angle_arcsec"), "is the sign of angle or torque reversed?"),
    "torque turned": (_torque(-1, "torque_Nm"), "is the sign of angle or torque reversed?"),
    "mrad as arcsec": (_angle(1e3 / ARCSEC_PER_RAD, "angle_arcsec"), "in mrad, not arcsec"),
    "arcmin as arcsec": (_angle(1 / 60, "angle_arcsec"), "in arcmin, not arcsec"),
    "arcsec as arcmin": (_angle(1, "angle_arcmin"), "in arcsec, not arcmin"),
    "arcsec as degrees": (_angle(1, "angle_deg"), "in arcsec, not deg"),
    "rad as mrad": (_angle(1 / ARCSEC_PER_RAD, "angle_mrad"), "in rad, not mrad"),
    "mN·m as N·m": (_torque(1e3, "torque_Nm"), "in mNm, not Nm"),
    "nothing connected": (Fault("angle_arcsec", lambda v: 12.5 + v * 1e-7, "angle_arcsec"), "connected?"),
}  # fmt: skip
"""Fault, and what the refusal asks; each is more than 30 times or turns the sign."""
STRANGE: dict[str, tuple[Fault, str]] = {
    "counts, 24 bits, as arcsec": (counts(24, "angle_arcsec"), "counts of an encoder"),
    "mrad as degrees": (_angle(1e3 / ARCSEC_PER_RAD, "angle_deg"), "in mrad, not deg"),
    "degrees as mrad": (_angle(1 / 3600, "angle_mrad"), "in deg, not mrad"),
}
"""Between 10 and 30 times: not refused, and no cause."""
