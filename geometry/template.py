"""Designs as TOML with comments, the schema's own descriptions: one to start from, or any other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.material import BEARING_STEEL, ElasticMaterial
from flexspline.geometry.schema import Location, allowed, json_schema, node_at
from flexspline.geometry.toml_text import quoted

__all__ = ["design_text", "json_schema", "template"]

Table = dict[str, Any]

OPTIONAL: frozenset[Location] = frozenset(
    {
        ("shaft", "keyway"),
        ("material", "shaft"),
        ("material", "circular_spline"),
        ("material", "bearing"),
        ("gear", "rated_torque_Nm"),
        ("gear", "working_depth_mm"),
        ("gear", "circular_spline_diameter_mm"),
        ("wave_generator",),
        ("solver", "edge_length_mm"),
    }
)
"""Written as comments: their absence means something."""

NO_REASONS: Mapping[Location, str] = {}

# The cup is that of examples/xb1-40.toml; the hat has the same tube, shorter.
_STEEL = {
    "name": "34CrNiMo6",
    "youngs_modulus_GPa": 206.0,
    "poissons_ratio": 0.3,
    "fatigue_limit_MPa": 500.0,
    "density_kg_per_m3": 7850.0,
}
_CUP: Table = {
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
_CUP_SHAFT: Table = {
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
_HAT: Table = {
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
_HAT_SHAFT: Table = {
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


_FIRST: dict[str, tuple[Table, Table]] = {"cup": (_CUP, _CUP_SHAFT), "hat": (_HAT, _HAT_SHAFT)}
"""Flexspline and shaft of each kind."""
MODELS = {"cup": "examples/xb1-40.toml", "hat": "`flexspline init hat`"}
"""Which design the first of a kind is."""


def template(kind: str = "cup") -> str:
    """Text of a design file that loads as it stands, every key with its meaning and unit.

    Raises
    ------
    DesignError : no such kind.
    """
    title = f"# A strain wave gear with a {kind}. Keys carry their units; unknown keys are refused."
    return text_of(title, first_values(kind), kind, {})


def text_of(
    title: str,
    values: Table,
    kind: str,
    why: Mapping[Location, str],
    stated: frozenset[Location] = frozenset(),
) -> str:
    """Text of a design file with these tables, every key with its meaning and why it has its value.

    `stated`: optional keys that are no comment.
    """
    lines = [title, *_lines((), values, kind, OPTIONAL - stated, optional=False, why=why)]
    return "\n".join(lines) + "\n"


def design_text(design: Design) -> str:
    """Text of a design file that loads as exactly this design, every key with its meaning."""
    values = design.model_dump(mode="json", exclude_none=True)
    lines = _lines((), values, design.flexspline.kind, frozenset(), optional=False)
    return "\n".join(lines) + "\n"


def first_values(kind: str) -> Table:
    """The tables of the first design of a kind.

    Raises
    ------
    DesignError : no such kind.
    """
    if kind not in _FIRST:
        known = " or ".join(f'"{k}"' for k in _FIRST)
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


def _lines(
    location: Location,
    table: Table,
    kind: str,
    hidden: frozenset[Location],
    optional: bool,
    why: Mapping[Location, str] = NO_REASONS,
) -> Iterator[str]:
    """The table's own keys, then the tables below it, as TOML wants them; `hidden` as comments."""
    for key, value in table.items():
        if not isinstance(value, dict | list):
            off = "# " if optional or (*location, key) in hidden else ""
            setting = f"{off}{key} = {_toml(value)}"
            reason = why.get((*location, key))
            assumed = f"; assumed: {reason}" if reason else ""
            yield f"{setting:<36} # {_meaning((*location, key), kind)}{assumed}"
    for key, value in table.items():
        below = (*location, key)
        off = "# " if optional or below in hidden else ""
        name = ".".join(str(part) for part in below)
        if isinstance(value, dict):
            if any(not isinstance(v, dict) for v in value.values()):  # [material] holds tables only
                yield ""
                yield f"{off + f'[{name}]':<36} # {_about(below, kind)}"
            yield from _lines(below, value, kind, hidden, bool(off), why)
        elif isinstance(value, list):
            for i, item in enumerate(value):
                yield f"{off + f'[[{name}]]':<36} # {_about((*below, i), kind)}"
                yield from _lines((*below, i), item, kind, hidden, bool(off), why)


def _about(location: Location, kind: str) -> str:
    """First line of a table's description."""
    return node_at(location, kind).get("description", "").partition("\n")[0]


def _meaning(location: Location, kind: str) -> str:
    return node_at(location, kind).get("description") or allowed(location, kind)


def _toml(value: str | float) -> str:
    """A number that reads back as the same double, or a basic string."""
    return quoted(value) if isinstance(value, str) else repr(value)
