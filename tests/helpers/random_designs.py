"""Random designs over the schema and beyond it: proportions first, then slips of the pen.

A design is the table of a design file; `toml` writes it as a person's editor might, NaN and all.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np

Table = dict[str, Any]

STEEL: Table = {"name": "34CrNiMo6", "youngs_modulus_GPa": 206.0, "poissons_ratio": 0.3}
SLIPS: tuple[object, ...] = (
    float("nan"), float("inf"), -float("inf"), -1.0, 0.0, -0.0, 1e-9, 1e300, 10**400, -(10**30), "0.4",
    "nan", "", "\x1b[31m", "x" * 5000, "$\\frac$", "#set page(width: 1pt)", "../../etc/passwd", True, [], {},
    [1.0, 2.0], {"a": 1}, [[[]]],
)  # fmt: skip
"""What a key may hold by mistake or malice."""
KEYS = (
    "wal_thickness_mm",
    "",
    "a.b",
    "two\nlines",
    "\x1b]0;title\x07",
    "k" * 3000,
    "__class__",
    "µ",
)
"""Keys that no table has."""


def design_of(seed: int, slips: bool = True) -> Table:
    """Design number `seed`; without slips it is one that was meant."""
    rng = np.random.default_rng([20261121, seed])
    table = _meant(rng)
    if slips and rng.random() < 0.3:
        for _ in range(int(rng.integers(1, 4))):
            _slip(table, rng)
    return table


def _meant(rng: np.random.Generator) -> Table:
    diameter = float(np.exp(rng.uniform(np.log(8), np.log(200))))
    wall = diameter * float(np.exp(rng.uniform(np.log(0.002), np.log(0.1))))
    kind = "cup" if rng.random() < 0.6 else "hat"
    flexspline = _tube(rng, diameter, wall) | {"kind": kind}
    flexspline |= _boss(rng, flexspline) if kind == "cup" else _flange(rng, flexspline)
    ring = diameter / 2 + flexspline["ring_thickness_mm"]
    teeth = int(rng.integers(30, 320))
    module = ring / (teeth / 2 - 1.25)  # tooth roots on the ring (ISO 53)
    stroke = 2 * int(rng.choice([1, 1, 1, 2, 3]))
    angle = float(rng.uniform(14, 30))
    largest_play = 1e3 * module * stroke * (1 - math.cos(math.radians(angle)))  # c_max [µm]
    table: Table = {
        "name": f"design of {diameter:.3g} mm",
        "flexspline": flexspline,
        "shaft": _shaft(rng, diameter),
        "material": {"flexspline": dict(STEEL)},
        "gear": {
            "module_mm": module,
            "teeth_flexspline": teeth,
            "teeth_circular_spline": teeth + stroke,
            "pressure_angle_deg": angle,
            "flank_clearance_um": float(rng.uniform(0, 20)),
        },
        "bearing": {"radial_clearance_um": largest_play * float(rng.uniform(0, 1.02))},
        "load": {"torque_Nm": float(np.exp(rng.uniform(np.log(1e-3), np.log(1e3))))},
        "uncertainty": {"youngs_modulus_pct": float(rng.uniform(0, 5))},
        "solver": {"tolerance_pct": float(rng.choice([0.1, 0.5, 1.0, 5.0]))},
    }
    if rng.random() < 0.3:
        own = {
            "youngs_modulus_GPa": float(rng.uniform(1, 400)),
            "poissons_ratio": float(rng.uniform(0, 0.49)),
        }
        table["material"]["shaft"] = STEEL | own
    if rng.random() < 0.1:
        flexspline["teeth"] = "drawn"
        flexspline["tooth_flank"] = str(rng.choice(["involute", "trapezoid"]))
    return table


def _tube(rng: np.random.Generator, diameter: float, wall: float) -> Table:
    length = diameter * float(rng.uniform(0.2, 1.5))
    ring = wall * float(rng.choice([1.0, rng.uniform(1, 3)]))
    diaphragm = wall * float(rng.uniform(0.5, 3))
    room = max(min(length - diaphragm, length - ring + wall), 0.01 * length)
    width = room * _share(rng)
    return {
        "inner_diameter_mm": diameter,
        "wall_thickness_mm": wall,
        "ring_thickness_mm": ring,
        "length_mm": length,
        "ring_width_mm": width,
        "ring_offset_mm": (room - width) * float(rng.choice([0.0, rng.uniform(0, 0.9)])),
        "diaphragm_thickness_mm": diaphragm,
    }


def _share(rng: np.random.Generator) -> float:
    """Of what fits: mostly inside, at times all of it or more."""
    return float(rng.choice([rng.uniform(0.05, 0.7), rng.uniform(0.7, 1.05)], p=[0.9, 0.1]))


def _below(f: Table) -> float:
    """Tube below the toothed ring and its shoulder [mm]."""
    under = f["length_mm"] - f["ring_offset_mm"] - f["ring_width_mm"]
    return max(under - (f["ring_thickness_mm"] - f["wall_thickness_mm"]), 0.0)


def _fillets(rng: np.random.Generator, radial: float, f: Table) -> Table:
    room = max(min(radial, _below(f) - f["diaphragm_thickness_mm"]), 0.0)
    inner = room * float(rng.choice([0.0, _share(rng)], p=[0.2, 0.8]))
    through = inner + f["wall_thickness_mm"] + f["diaphragm_thickness_mm"]
    outer = min(room, through) * float(rng.choice([0.0, _share(rng)], p=[0.2, 0.8]))
    return {"inner_fillet_mm": inner, "outer_fillet_mm": outer}


def _bolts(rng: np.random.Generator, inner: float, outer: float) -> Table:
    """Holes between two diameters, on half of the parts."""
    if rng.random() < 0.5:
        return {"bolt_count": 0}
    hole = (outer - inner) / 2 * float(rng.uniform(0.1, 0.9))
    circle = (inner + outer) / 2 + float(rng.uniform(-0.55, 0.55)) * ((outer - inner) / 2 - hole)
    most = max(1, int(math.pi * circle / max(hole, 1e-3) * 0.8))
    count = int(rng.integers(1, min(most, 16) + 1))
    return {"bolt_count": count, "bolt_circle_diameter_mm": circle, "bolt_hole_diameter_mm": hole}


def _boss(rng: np.random.Generator, f: Table) -> Table:
    boss = f["inner_diameter_mm"] * float(rng.uniform(0.2, 0.95))
    bore = boss * float(rng.choice([0.0, rng.uniform(0.05, 0.9)]))
    h = f["diaphragm_thickness_mm"]
    own = {
        "boss_diameter_mm": boss,
        "bore_diameter_mm": bore,
        "boss_thickness_mm": h
        + (f["length_mm"] - h) * float(rng.choice([0.0, rng.uniform(0.01, 0.5)])),
    }
    return own | _fillets(rng, (f["inner_diameter_mm"] - boss) / 2, f) | _bolts(rng, bore, boss)


def _flange(rng: np.random.Generator, f: Table) -> Table:
    outside = f["inner_diameter_mm"] + 2 * f["wall_thickness_mm"]
    inner = outside * float(rng.uniform(1.02, 2))
    outer = inner * float(rng.uniform(1.05, 2))
    h = f["diaphragm_thickness_mm"]
    own = {
        "flange_inner_diameter_mm": inner,
        "flange_outer_diameter_mm": outer,
        "flange_thickness_mm": h
        + (f["length_mm"] - h) * float(rng.choice([0.0, rng.uniform(0.01, 0.5)])),
    }
    return own | _fillets(rng, (inner - outside) / 2, f) | _bolts(rng, inner, outer)


def _shaft(rng: np.random.Generator, diameter: float) -> Table:
    """One to five segments; bores may close and open again."""
    segments = []
    for _ in range(int(rng.integers(1, 6))):
        outer = diameter * float(rng.uniform(0.15, 0.8))
        bore = outer * float(rng.choice([0.0, rng.uniform(0.1, 0.85)]))
        if segments and rng.random() < 0.7:  # the bore goes on, as it is drilled
            bore = min(segments[0]["inner_diameter_mm"], 0.9 * outer)
        if segments and rng.random() < 0.95:  # the two meet
            before = segments[-1]
            outer = max(outer, 1.1 * before["inner_diameter_mm"])
            bore = min(bore, 0.9 * before["outer_diameter_mm"])
        length = diameter * float(np.exp(rng.uniform(np.log(0.03), np.log(1.0))))
        segments.append(
            {"length_mm": length, "outer_diameter_mm": outer, "inner_diameter_mm": bore}
        )
    steps = [
        abs(a["outer_diameter_mm"] - b["outer_diameter_mm"]) / 2 for a, b in pairwise(segments)
    ]
    room = min([*steps, *(s["length_mm"] / 2 for s in segments)])
    whole = sum(s["length_mm"] for s in segments)
    first, last = segments[0], segments[-1]
    shaft: Table = {
        "fillet_mm": room * float(rng.choice([0.0, _share(rng)])),
        "grip_length_mm": min(last["length_mm"] * float(rng.uniform(0.1, 1.1)), 0.98 * whole),
        "segment": segments,
    }
    shaft |= _bolts(rng, first["inner_diameter_mm"], first["outer_diameter_mm"])
    if rng.random() < 0.25:
        radius = last["outer_diameter_mm"] / 2
        depth = (radius - last["inner_diameter_mm"] / 2) * float(rng.uniform(0.05, 0.95))
        chord = 2 * math.sqrt(max(radius**2 - (radius - depth) ** 2, 0))
        shaft["keyway"] = {
            "depth_mm": depth,
            "width_mm": chord * float(rng.uniform(0.1, 1.05)),
            "length_mm": last["length_mm"] * float(rng.uniform(0.1, 1.3)),
        }
    return shaft


def _slip(table: Table, rng: np.random.Generator) -> None:
    """One mistake somewhere in the table, in place."""
    tables = [*_tables(table)]
    inside = tables[int(rng.integers(len(tables)))]
    keys = list(inside) or ["nothing"]
    key = keys[int(rng.integers(len(keys)))]
    value = inside.get(key, 1.0)
    acts: list[Callable[[], object]] = [
        lambda: inside.pop(key, None),
        lambda: inside.update({key: SLIPS[int(rng.integers(len(SLIPS)))]}),
        lambda: inside.update({KEYS[int(rng.integers(len(KEYS)))]: 1.0}),
        lambda: _scaled(inside, key, value, float(np.exp(rng.normal(0, 3)))),
        lambda: _scaled(inside, key, value, -1.0),
    ]
    acts[int(rng.integers(len(acts)))]()


def _scaled(inside: Table, key: str, value: object, factor: float) -> None:
    if isinstance(value, float):
        inside[key] = value * factor
    elif isinstance(value, int):
        inside[key] = round(value * factor)


def _tables(value: object) -> list[Table]:
    """A table and all below it."""
    if isinstance(value, list):
        return [t for v in value for t in _tables(v)]
    if not isinstance(value, dict):
        return []
    return [value, *(t for v in value.values() for t in _tables(v))]


def toml(value: object) -> str:
    """A table as the text of a TOML file: inline below the top, which every reader takes."""
    if isinstance(value, dict):
        return "".join(f"{_quoted(k)} = {_inline(v)}\n" for k, v in value.items())
    raise TypeError("a file is a table")


def _inline(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_inline, value))}]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_quoted(k)} = {_inline(v)}" for k, v in value.items()) + "}"
    return str(value) if isinstance(value, int) else repr(value)  # nan and inf are TOML's words too


def _quoted(text: str) -> str:
    escaped = "".join(f"\\u{ord(c):04x}" if ord(c) < 32 or c in '"\\\x7f' else c for c in text)
    return f'"{escaped}"'
