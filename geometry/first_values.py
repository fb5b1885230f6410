"""The tables of the design that a new file begins with, of each kind."""

from __future__ import annotations

from flexspline.geometry.errors import DesignError
from flexspline.geometry.listed import joined
from flexspline.geometry.material import BEARING_STEEL, STEEL_KG_PER_M3, ElasticMaterial
from flexspline.geometry.shapes import KINDS, SHAPES
from flexspline.geometry.toml_text import TomlTable, quoted

_STEEL = {
    "name": "34CrNiMo6",
    "youngs_modulus_GPa": 206.0,
    "poissons_ratio": 0.3,
    "fatigue_limit_MPa": 500.0,
    "density_kg_per_m3": STEEL_KG_PER_M3,
}


def first_values(kind: str) -> TomlTable:
    """The tables of the first design of a kind.

    Raises
    ------
    DesignError : no such kind.
    """
    if kind not in SHAPES:
        known = joined(map(quoted, KINDS), "or")
        raise DesignError("kind", kind, f"must be {known}")
    first = SHAPES[kind].first
    return {
        "name": f"my {kind}",
        "flexspline": first.flexspline,
        "shaft": first.shaft,
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
