"""The one table of quantities: result.json key, unit, long name, symbol and how it is printed.

Console, CSV, charts and reports take a figure's unit, name and format from here and name it by its key alone.
Keys that hold no printed figure (places, sentences) are written by `records.py`; docs/contract.md lists all.
The whole gear's part of the table stands in `gear_quantities.py`.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain

from flexspline.pipeline.rim_case import RIM_CASES, RimCase, figure_of
from flexspline.results.gear_quantities import GEAR_QUANTITIES
from flexspline.results.quantity import STIFFNESS_UNIT, Quantity


def bounds_kind(guaranteed: bool) -> str:
    """What bounds are: "guaranteed" where both ends are theorems, else "estimated"."""
    return "guaranteed" if guaranteed else "estimated"


def _with_bounds(value: Quantity, of: str) -> tuple[Quantity, Quantity]:
    """A stiffness and its bounds, "Bounds of the …"."""
    key = value.key.replace("_Nm_per_rad", "_bounds_Nm_per_rad")
    name = f"Bounds of the {of}"
    return value, Quantity(key, value.unit, name, value.symbol, "bounds", value.digits)


_RIM_WORDS: Mapping[RimCase, tuple[str, str, str, str, str]] = {
    "lobes": (
        "K_b,lobes",
        "Flexspline stiffness, torque at the two lobes (lobes)",
        "load at two lobes",
        "flexspline stiffness (lobes)",
        "cos² traction within ±30° of the major axis, seat held radially",
    ),
    "lobes_contact": (
        "K_b,contact",
        "Flexspline stiffness, torque at the two lobes, rim may lift off",
        "lobes, rim may lift",
        "flexspline stiffness, lobes, rim may lift off",
        "same traction, the rim rests on the seat and may lift off",
    ),
    "lobes_unsupported": (
        "K_b,free",
        "Flexspline stiffness, torque at the two lobes, rim unsupported",
        "lobes, rim free",
        "flexspline stiffness, lobes, rim unsupported",
        "same traction, nothing on the seat",
    ),
}
"""Symbol, name, short name, what its bounds are of, note: of load cases with more to say than their title."""


def _of_rim_case(case: RimCase) -> tuple[Quantity, Quantity]:
    """A load case's own words, else those that its title gives."""
    title, index = RIM_CASES[case].title, case.replace("_", " ")
    name = f"Flexspline stiffness, {title}"
    usual = (f"K_b,{index}", name, title, name[0].lower() + name[1:], "")
    symbol, name, short, of, note = _RIM_WORDS.get(case, usual)
    key = f"{figure_of(case)}_Nm_per_rad"
    return _with_bounds(
        Quantity(key, STIFFNESS_UNIT, name, symbol, note=note, short_name=short), of
    )


QUANTITIES: tuple[Quantity, ...] = (
    Quantity("design", "", "Design", kind="text"),
    Quantity("version", "", "Program version", kind="text"),
    *_with_bounds(
        Quantity(
            "K_b_Nm_per_rad",
            STIFFNESS_UNIT,
            "Flexspline stiffness, uniform torque on the ring",
            "K_b",
            digits=5,
            note="ring turned rigidly, mount held",
            short_name="flexspline, uniform",
        ),
        "flexspline stiffness (uniform)",
    ),
    *chain.from_iterable(map(_of_rim_case, RIM_CASES)),
    *_with_bounds(
        Quantity(
            "K_e_Nm_per_rad",
            STIFFNESS_UNIT,
            "Output shaft stiffness",
            "K_e",
            digits=5,
            note="grip turned rigidly, mount held",
            short_name="output shaft",
        ),
        "output shaft stiffness",
    ),
    Quantity(
        "given.K_b_Nm_per_rad", STIFFNESS_UNIT, "Flexspline stiffness, given", "K_b", digits=5
    ),
    Quantity(
        "given.K_e_Nm_per_rad", STIFFNESS_UNIT, "Output shaft stiffness, given", "K_e", digits=5
    ),
    Quantity(
        "K_series_Nm_per_rad",
        STIFFNESS_UNIT,
        "Series stiffness of flexspline and shaft",
        "K",
        digits=5,
        short_name="both in series",
    ),
    Quantity(
        "wave_generator_peak_mises_MPa",
        "MPa",
        "Peak von Mises stress, wave-generator ellipse",
        "σ_WG",
        digits=3,
        short_name="wave generator",
    ),
    Quantity(
        "wave_generator_peak_half_seat_mises_MPa",
        "MPa",
        "Peak von Mises stress, ellipse, seat half as wide as the ring",
        "σ_WG,half",
        digits=3,
    ),
    Quantity(
        "torque_peak_mises_MPa",
        "MPa",
        "Peak von Mises stress, load torque",
        "σ_T",
        digits=3,
        short_name="flexspline, load torque",
    ),
    Quantity(
        "shaft_torque_peak_mises_MPa",
        "MPa",
        "Peak von Mises stress of the shaft, load torque",
        "σ_T,shaft",
        digits=3,
        short_name="shaft, load torque",
    ),
    *(
        Quantity(f"{part}_{key}", unit, f"{name} of the {part}", f"{symbol}_{index}")
        for part, index in (("flexspline", "b"), ("shaft", "e"))
        for key, unit, name, symbol in (
            ("mass_g", "g", "Mass", "m"),
            ("length_mm", "mm", "Length", "L"),
        )
    ),
    Quantity("ring_thickness_mm", "mm", "Rim under the teeth", "t_rim"),
    *(
        Quantity(
            f"equivalent_ring_thickness{leaf}_mm",
            "mm",
            f"Plain ring as stiff as the toothed one, {name}",
            symbol,
        )
        for leaf, name, symbol in (
            ("", "bending (in K_b)", "t_b"),
            ("_membrane", "membrane", "t_m"),
            ("_torsion", "torsion", "t_t"),
        )
    ),
    Quantity(
        "equivalent_ring_difference_pct",
        "%",
        "That plain ring (bending), thicker than the rim by",
        decimals=1,
    ),
    *(
        Quantity(
            f"backlash_arcsec.{leaf}",
            "arcsec",
            name,
            symbol,
            decimals=1,
        )
        for leaf, name, symbol in (
            ("shaft", "Shaft wind-up", "Δ_1"),
            ("flexspline", "Flexspline wind-up", "Δ_2"),
            ("flank_clearance", "Flank clearance", "Δ_3"),
            ("bearing_play", "Bearing play", "Δ_4"),
            ("total", "Backlash, total", "Δ_bl"),
            ("std", "Standard deviation of the total", "s_bl"),
        )
    ),
    Quantity(
        "extended.total_arcsec",
        "arcsec",
        "Backlash with the extended model",
        "Δ_ext",
        decimals=1,
    ),
    Quantity(
        "linear_torque_limit_Nm",
        "N·m",
        "Torque limit of the linear model, ellipse stress not counted",
        "T_lin",
        digits=3,
    ),
    Quantity(
        "linear_torque_limit_reason",
        "",
        "Reason for that limit",
        kind="text",
    ),
    *GEAR_QUANTITIES,
    Quantity("solver.model", "", "Model of K_b", kind="text"),
    Quantity("solver.elements", "", "Elements, finest mesh", kind="count"),
    Quantity("solver.dofs", "", "Unknowns, finest mesh", kind="count"),
    Quantity("solver.wall_s", "s", "Elapsed time", decimals=1),
    Quantity("solver.symmetry", "", "Part solved", kind="text"),
)

BY_KEY = {q.key: q for q in QUANTITIES}


def quantities_of(group: str) -> tuple[Quantity, ...]:
    """The quantities of a group, in the table's order."""
    return tuple(q for q in QUANTITIES if q.group == group)


def quantity(key: str) -> Quantity:
    """The entry of a result.json key (nested keys joined by dots).

    Raises
    ------
    KeyError : no such key in the table.
    """
    return BY_KEY[key]
