"""The tables of the design that a new file begins with, of each kind."""

from __future__ import annotations

from typing import Any

from flexspline.geometry.errors import DesignError
from flexspline.geometry.listed import joined
from flexspline.geometry.material import BEARING_STEEL, STEEL_KG_PER_M3, ElasticMaterial
from flexspline.geometry.toml_text import quoted

TomlTable = dict[str, Any]

# The cup is that of examples/xb1-40.toml, which leaves out what has a default; but its shaft is 17 mm in
# diameter where that has 18: the keyway offered is a usual one there. The hat has the same tube, shorter.
_STEEL = {
    "name": "34CrNiMo6",
    "youngs_modulus_GPa": 206.0,
    "poissons_ratio": 0.3,
    "fatigue_limit_MPa": 500.0,
    "density_kg_per_m3": STEEL_KG_PER_M3,
}
_CUP: TomlTable = {
    "kind": "cup",
    "inner_diameter_mm": 38.4,
    "wall_thickness_mm": 0.4,
    "ring_thickness_mm": 0.55,
    "length_mm": 30.0,
    "ring_width_mm": 8.0,
    "ring_offset_mm": 0.0,
    "diaphragm_thickness_mm": 0.6,
    "boss_diameter_mm": 18.0,
    "boss_thickness_mm": 3.0,
    "bore_diameter_mm": 8.0,
    "inner_fillet_mm": 1.0,
    "outer_fillet_mm": 1.0,
    "teeth": "none",
    "tooth_flank": "involute",
    "bolt_count": 6,
    "bolt_circle_diameter_mm": 13.0,
    "bolt_hole_diameter_mm": 2.5,
}
_CUP_SHAFT: TomlTable = {
    "bolt_count": 6,
    "bolt_circle_diameter_mm": 13.0,
    "bolt_hole_diameter_mm": 2.5,
    "fillet_mm": 0.5,
    "grip_length_mm": 10.0,
    "segment": [
        {"length_mm": 4.0, "outer_diameter_mm": 20.0, "inner_diameter_mm": 6.0},
        {"length_mm": 24.0, "outer_diameter_mm": 17.0, "inner_diameter_mm": 6.0},
    ],
    "keyway": {"width_mm": 5.0, "depth_mm": 3.0, "length_mm": 10.0},
}
_HAT: TomlTable = {
    "kind": "hat",
    "inner_diameter_mm": 38.4,
    "wall_thickness_mm": 0.4,
    "ring_thickness_mm": 0.55,
    "length_mm": 22.0,
    "ring_width_mm": 8.0,
    "ring_offset_mm": 0.0,
    "diaphragm_thickness_mm": 0.4,
    "flange_outer_diameter_mm": 68.0,
    "flange_inner_diameter_mm": 54.0,
    "flange_thickness_mm": 3.0,
    "inner_fillet_mm": 1.0,
    "outer_fillet_mm": 1.0,
    "teeth": "none",
    "tooth_flank": "involute",
    "bolt_count": 12,
    "bolt_circle_diameter_mm": 61.0,
    "bolt_hole_diameter_mm": 3.2,
}
_HAT_SHAFT: TomlTable = {
    "bolt_count": 12,
    "bolt_circle_diameter_mm": 61.0,
    "bolt_hole_diameter_mm": 3.2,
    "fillet_mm": 1.0,
    "grip_length_mm": 10.0,
    "segment": [
        {"length_mm": 6.0, "outer_diameter_mm": 68.0, "inner_diameter_mm": 20.0},
        {"length_mm": 18.0, "outer_diameter_mm": 32.0, "inner_diameter_mm": 20.0},
    ],
    "keyway": {"width_mm": 5.0, "depth_mm": 3.0, "length_mm": 10.0},
}
_FIRST: dict[str, tuple[TomlTable, TomlTable]] = {
    "cup": (_CUP, _CUP_SHAFT),
    "hat": (_HAT, _HAT_SHAFT),
}
"""Flexspline and shaft of each kind."""
MODELS = {"cup": "examples/xb1-40.toml", "hat": "`flexspline init hat`"}
"""Which design the first of a kind is."""

LESS_BENT = {
    "cup": "Thinner parts lower the stress",
    "hat": "A longer tube or a narrower ring lowers the stress",
}
"""What lowers the stress on the wave generator."""
BENT = {"hat": "The wave generator stresses it above its fatigue limit (`flexspline run`)"}
"""Of the first design of a kind where it does."""


def first_values(kind: str) -> TomlTable:
    """The tables of the first design of a kind.

    Raises
    ------
    DesignError : no such kind.
    """
    if kind not in _FIRST:
        known = joined(map(quoted, _FIRST), "or")
        raise DesignError("kind", kind, f"must be {known}")
    flexspline, shaft = _FIRST[kind]
    return {
        "name": f"my {kind}",
        "flexspline": flexspline,
        "shaft": shaft,
        "material": {
            "flexspline": _STEEL,
            "shaft": _STEEL,
            "circular_spline": {
                k: v for k, v in _STEEL.items() if k in ElasticMaterial.model_fields
            },
            "bearing": BEARING_STEEL.model_dump(),
        },
        "gear": {
            "module_mm": 0.2,
            "teeth_flexspline": 200,
            "teeth_circular_spline": 202,
            "pressure_angle_deg": 20.0,
            "flank_clearance_um": 3.0,
            "rated_torque_Nm": 23.0,
            "flanks": "relieved",
            "tooth_face": "relieved",
            "working_depth_mm": 0.268,
            "circular_spline_diameter_mm": 54.5,
        },
        "bearing": {"radial_clearance_um": 12.0, "bearing_play_model": "involute"},
        "wave_generator": {
            "deflection_mm": 0.2,
            "ball_count": 23,
            "ball_diameter_mm": 3.8,
            "race_thickness_mm": 0.8,
        },
        "load": {"torque_Nm": 0.5},
        "uncertainty": {
            "youngs_modulus_pct": 2.0,
            "flank_clearance_um": 1.0,
            "radial_clearance_um": 2.5,
        },
        "solver": {
            "model": "auto",
            "mesher": "auto",
            "load_case": "uniform",
            "tolerance_pct": 0.5,
            "edge_length_mm": 1.0,
        },
    }
