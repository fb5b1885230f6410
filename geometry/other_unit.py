"""A key with another unit in its name, as torque_Nmm for torque_Nm: the key meant, and the factor."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import pi

INCH_mm = 25.4
"""Exact: NIST SP 811 (2008), appendix B.8."""
KGF_N = 9.80665
"""Kilogram-force; exact, as above."""
LB_kg = 0.45359237
"""Avoirdupois pound; exact, as above."""
LBF_N = LB_kg * KGF_N
"""Pound-force."""
PSI_GPa = LBF_N / INCH_mm**2 / 1e3
"""Pound-force per square inch."""
_FORCES = {
    "N": 1.0, "mN": 1e-3, "kN": 1e3, "MN": 1e6,
    "kgf": KGF_N, "gf": KGF_N / 1e3, "lbf": LBF_N, "ozf": LBF_N / 16,
}  # fmt: skip
_LENGTHS = {
    "mm": 1.0, "um": 1e-3, "nm": 1e-6, "cm": 10.0, "m": 1e3,
    "in": INCH_mm, "inch": INCH_mm, "mil": INCH_mm / 1e3, "thou": INCH_mm / 1e3, "ft": 12 * INCH_mm,
}  # fmt: skip
_ARMS = ("m", "cm", "mm", "in", "ft")
"""Lengths in units of torque."""


def _torques() -> Iterator[tuple[str, str, float]]:
    """Spelling, how it is said, and what one of it is in N·m; a pound or a kilogram is one of force."""
    for force, newtons in _FORCES.items():
        for arm in _ARMS:
            metric = "N" in force
            name = f"{arm}·{force}" if force in ("lbf", "ozf") else f"{force}·{arm}"
            for short in {force} if metric else {force, force.removesuffix("f")}:
                spellings = [f"{short}{arm}", f"{short}_{arm}"]
                if not metric:
                    spellings += [f"{arm}{short}", f"{arm}_{short}"]
                for spelling in spellings:
                    yield spelling, name, newtons * _LENGTHS[arm] / 1e3


_ALIKE: tuple[Mapping[str, float], ...] = (
    _LENGTHS,
    {spelling: Nm for spelling, _, Nm in _torques()},
    _FORCES,
    {
        "GPa": 1.0, "MPa": 1e-3, "kPa": 1e-6, "Pa": 1e-9, "N_per_mm2": 1e-3, "kN_per_mm2": 1.0, "bar": 1e-4,
        "kgf_per_mm2": KGF_N / 1e3, "psi": PSI_GPa, "ksi": 1e3 * PSI_GPa, "Mpsi": 1e6 * PSI_GPa,
    },
    {"deg": 1.0, "rad": 180 / pi, "mrad": 0.18 / pi, "arcmin": 1 / 60, "arcsec": 1 / 3600},
    {
        "kg_per_m3": 1.0, "g_per_cm3": 1e3, "kg_per_dm3": 1e3, "t_per_m3": 1e3,
        "lb_per_in3": LB_kg / (INCH_mm / 1e3) ** 3,
    },
)  # fmt: skip
"""Units of one quantity, each with what one of it is in the first."""
_SAID = {spelling: said for spelling, said, _ in _torques()} | {
    "in": "inches",
    "inch": "inches",
    "ft": "feet",
}
"""A unit in a sentence, where it is not as in a key."""
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
    OtherUnit(key='torque_Nm', how='divide a value in N·mm by 1000')
    >>> other_unit("wall_thickness_in", ["wall_thickness_mm"]).how
    'multiply a value in inches by 25.4'
    >>> other_unit("torque_in_lb", ["torque_Nm"]).how
    'multiply a value in in·lbf by 0.112985'
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
    name, over = _SAID.get(unit, unit), round(1 / factor)
    if over >= 1 and abs(factor * over - 1) < ROUND:
        return (
            f"a value in {name} stays as it is"
            if over == 1
            else f"divide a value in {name} by {over}"
        )
    by = f"{round(factor)}" if abs(factor - round(factor)) < ROUND * factor else f"{factor:.6g}"
    return f"multiply a value in {name} by {by}"
