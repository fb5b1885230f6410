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


def _stiffness(
    key: str, digits: int, symbol: str, name: str, short_name: str, bounded: str, note: str
) -> tuple[Quantity, Quantity]:
    """A stiffness and its bounds."""
    value, bounds = f"{key}_Nm_per_rad", f"{key}_bounds_Nm_per_rad"
    return (
        Quantity(
            value,
            STIFFNESS_UNIT,
            name,
            symbol,
            digits=digits,
            note=note,
            short_name=short_name,
        ),
        Quantity(bounds, STIFFNESS_UNIT, f"Bounds of the {bounded}", symbol, "bounds", digits),
    )


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
"""As of `_stiffness`, from its symbol on: of load cases that have more to say than their title."""


def _of_rim_case(case: RimCase) -> tuple[Quantity, Quantity]:
    """A load case's own words, else those that its title gives."""
    title, index = RIM_CASES[case].title, case.replace("_", " ")
    name = f"Flexspline stiffness, {title}"
    usual = (f"K_b,{index}", name, title, name[0].lower() + name[1:], "")
    return _stiffness(figure_of(case), 4, *_RIM_WORDS.get(case, usual))


QUANTITIES: tuple[Quantity, ...] = (
    Quantity("design", "", "Design", kind="text"),
    Quantity("version", "", "Program version", kind="text"),
    *_stiffness(
        "K_b",
        5,
        "K_b",
        "Flexspline stiffness, uniform torque on the ring",
        "flexspline, uniform",
        "flexspline stiffness (uniform)",
        "ring turned rigidly, mount held",
    ),
    *chain.from_iterable(map(_of_rim_case, RIM_CASES)),
    *_stiffness(
        "K_e",
        5,
        "K_e",
        "Output shaft stiffness",
        "output shaft",
        "output shaft stiffness",
        "grip turned rigidly, mount held",
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
