"""Names and units of a study's columns: figures from the one table, design keys from the schema."""

from __future__ import annotations

from results.quantities import BY_KEY, Quantity

_BOUND = {"[0]": "lower bound", "[1]": "upper bound"}
_SIZES = {
    "flexspline_mass_g": Quantity("", "", "g", "Mass of the flexspline", "m_b"),
    "flexspline_length_mm": Quantity("", "", "mm", "Length of the flexspline", "L"),
    "shaft_mass_g": Quantity("", "", "g", "Mass of the shaft", "m_e"),
    "shaft_length_mm": Quantity("", "", "mm", "Length of the shaft", "L_e"),
    "shaft_torque_peak_mises_MPa": Quantity(
        "", "", "MPa", "Peak von Mises stress of the shaft, load torque", "σ_e", digits=3
    ),
}
_UNITS = {"mm": "mm", "um": "µm", "GPa": "GPa", "MPa": "MPa", "Nm": "N·m", "deg": "deg", "pct": "%"}


def entry(key: str) -> Quantity:
    """Name, unit and format of a figure or of a design key."""
    if key in BY_KEY:
        return BY_KEY[key]
    if key in _SIZES:
        return _SIZES[key]
    stem, bound = key[:-3], _BOUND.get(key[-3:])
    if bound and stem in BY_KEY:
        q = BY_KEY[stem]
        return Quantity(key, key, q.unit, f"{q.name}, {bound}", q.symbol, digits=q.digits)
    return _design_key(key)


def _design_key(key: str) -> Quantity:
    """``flexspline.wall_thickness_mm`` → "wall thickness" in mm."""
    head, _, last = key.rpartition(".")
    words, _, suffix = last.rpartition("_")
    unit = _UNITS.get(suffix, "")
    name = (words if unit else last).replace("_", " ")
    if head not in ("flexspline", "gear", "bearing", "load"):
        name = f"{head.replace('.', ' ').replace('_', ' ')} {name}"
    return Quantity(key, key, unit, name)
