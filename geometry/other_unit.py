"""A key with another unit in its name, as torque_Nmm for torque_Nm: the key meant, and the factor."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import pi

INCH_mm = 25.4
"""Exact: NIST SP 811 (2008), appendix B.8."""
_ALIKE: tuple[Mapping[str, float], ...] = (
    {"mm": 1.0, "um": 1e-3, "nm": 1e-6, "cm": 10.0, "m": 1e3, "in": INCH_mm, "inch": INCH_mm},
    {"Nm": 1.0, "Nmm": 1e-3, "mNm": 1e-3, "Ncm": 1e-2, "kNm": 1e3},
    {"N": 1.0, "kN": 1e3, "mN": 1e-3},
    {"GPa": 1.0, "MPa": 1e-3, "kPa": 1e-6, "Pa": 1e-9, "N_per_mm2": 1e-3},
    {"deg": 1.0, "rad": 180 / pi, "mrad": 0.18 / pi, "arcmin": 1 / 60, "arcsec": 1 / 3600},
    {"kg_per_m3": 1.0, "g_per_cm3": 1e3, "kg_per_dm3": 1e3, "t_per_m3": 1e3},
)
"""Units of one quantity, each with what one of it is in the first."""
ROUND = 1e-9
"""A factor this close to one over a whole number divides by it."""


@dataclass(frozen=True)
class OtherUnit:
    """The known key that was meant, and what to do with a value in the unit written."""

    key: str
    how: str


def other_unit(key: str, known: Iterable[str]) -> OtherUnit | None:
    """Where `key` is a known one but for its unit; None where it is not.

    Examples
    --------
    >>> other_unit("torque_Nmm", ["torque_Nm"])
    OtherUnit(key='torque_Nm', how='divide a value in Nmm by 1000')
    >>> other_unit("wall_thickness_in", ["wall_thickness_mm"]).how
    'multiply a value in in by 25.4'
    """
    for meant in known:
        for units in _ALIKE:
            for ours, one in units.items():
                stem = meant.removesuffix(f"_{ours}")
                written = key.removeprefix(f"{stem}_")
                if stem != meant and written != key and written in units and written != ours:
                    return OtherUnit(meant, _how(written, units[written] / one))
    return None


def _how(unit: str, factor: float) -> str:
    over = round(1 / factor)
    if over >= 1 and abs(factor * over - 1) < ROUND:
        return (
            f"a value in {unit} stays as it is"
            if over == 1
            else f"divide a value in {unit} by {over}"
        )
    return f"multiply a value in {unit} by {factor:.6g}"
