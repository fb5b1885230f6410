"""The figures of docs/whole-gear.md: the examples, a published cup, catalogues, sensitivities."""

from __future__ import annotations

import csv
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median

import numpy as np

from flexspline.fea.gear.model import GearModel
from flexspline.geometry.design import Design
from flexspline.geometry.gear_assumptions import gear_assumptions
from flexspline.geometry.load import design_from, load_design
from flexspline.geometry.rated import rated_torque
from flexspline.geometry.sized import WALL_SHARE, sized_template
from flexspline.pipeline import revolved
from flexspline.pipeline.analysis import analysis_context
from flexspline.pipeline.backlash import backlash
from flexspline.pipeline.gear.gear_chain import Chain, chain_of, chords
from flexspline.pipeline.gear.gear_curve import LOADING, GearCurve, curve_of
from flexspline.pipeline.gear.gear_model import gear_model
from flexspline.pipeline.gear.gear_terms import TIGHT, gear_terms, small_torque
from flexspline.pipeline.part_stiffness import part_stiffness

ROOT = Path(__file__).parents[1]
CATALOGUE = ROOT / "examples" / "catalogue"
RELATIVE_WIDTH = 0.005
"""Of the bounds of K_e in the catalogue's rows."""
STEP = 1.2
"""By which each proportion is changed for its sensitivity."""


@dataclass(frozen=True)
class Row:
    """One line of a catalogue, K in N·m/rad; None: not given. Predicted: without and with the shaft."""

    source: str
    size: float
    ratio: str
    torques: tuple[float, float, float]
    given: tuple[float | None, float | None, float | None]
    alone: tuple[float, ...]
    with_shaft: tuple[float, ...]

    def over(self, predicted: tuple[float, ...]) -> tuple[float | None, ...]:
        """Predicted over catalogue: K1, K2, K3, K3/K1."""
        parts = [None if g is None else p / g for p, g in zip(predicted, self.given, strict=True)]
        both = parts[0] is not None and parts[2] is not None
        return (*parts, parts[2] / parts[0] if both else None)


def rows() -> Iterator[Row]:
    """23 rows of one maker with three K each, 4 of another with K1 and K3."""
    designs: dict[tuple[float, int], tuple[GearModel, float]] = {}

    def found(source: str, size: float, text: str, T1: float, T2: float, given: tuple) -> Row:
        ratio = 100 if text.startswith(">") else int(text)
        if (size, ratio) not in designs:
            designs[size, ratio] = sized(size, ratio)
        model, shaft = designs[size, ratio]
        torques = (T1, T2, 2 * T2)
        alone, with_shaft = (slopes(Chain(model, s, 0.0), torques) for s in (0.0, shaft))
        return Row(source, size, text, torques, given, alone, with_shaft)

    marks: dict[float, tuple[float, float]] = {}
    with (CATALOGUE / "hd_torsional_stiffness.csv").open(encoding="utf-8") as file:
        for line in csv.DictReader(file):
            T1, T2 = float(line["T1_Nm"]), float(line["T2_Nm"])
            marks[float(line["size"])] = T1, T2
            if line["K3_1e4_Nm_per_rad"]:
                given = tuple(1e4 * float(line[f"K{i}_1e4_Nm_per_rad"]) for i in (1, 2, 3))
                text = line["ratio_class"].split()[0]
                yield found("CSF/CSG, CHA", float(line["size"]), text, T1, T2, given)
    with (CATALOGUE / "schaeffler_TPI275_RT1-H-CS_i100.csv").open(encoding="utf-8") as file:
        for line in csv.DictReader(file):
            size = float(line["size"])
            given = float(line["K1_Nm_per_rad"]), None, float(line["K3_Nm_per_rad"])
            yield found("RT1-H", size, "100", *marks[size], given)


def sized(size: float, ratio: int) -> tuple[GearModel, float]:
    """The contact model of `flexspline init cup`, and its shaft's compliance [rad/(N·m)]."""
    design = sized_design(size, ratio)
    shaft = revolved.stiffness(design, "shaft", RELATIVE_WIDTH).K_Nm_per_rad
    return gear_model(design, design.part("flexspline")), 1 / shaft


def sized_design(size: float, ratio: int) -> Design:
    """That `flexspline init cup` prints."""
    return design_from(tomllib.loads(sized_template("cup", size, ratio)))


def slopes(chain: Chain, torques: tuple[float, ...]) -> tuple[float, ...]:
    """K1, K2, K3 of T1, T2 and an upper torque [N·m/rad]."""
    every = [LOADING[0] * torques[-1], *torques]
    return chords(every, chain.angles(every))


def cell(value: float | None) -> str:
    """Of a table."""
    return "–" if value is None else f"{value:.2f}"


def catalogue_table(found: list[Row]) -> str:
    """Predicted over catalogue, row by row, without and with the shaft."""
    lines = [
        f"| {r.source} | {r.size:g} | {r.ratio} | {' | '.join(cell(x) for x in r.over(r.alone))} | "
        f"{' | '.join(cell(x) for x in r.over(r.with_shaft))} |"
        for r in found
    ]
    return "\n".join(lines)


def by_class(found: list[Row]) -> str:
    """Median of predicted over catalogue by ratio class."""
    lines = []
    for name, belongs in (
        ("30", lambda r: r.ratio == "30"),
        ("50", lambda r: r.ratio == "50"),
        ("80 to 160", lambda r: r.ratio not in ("30", "50")),
        ("all", lambda r: True),
    ):
        mine = [r for r in found if belongs(r)]
        columns = [
            [x for r in mine if (x := r.over(p(r))[i]) is not None]
            for p in (lambda r: r.alone, lambda r: r.with_shaft)
            for i in range(4)
        ]
        words = " | ".join(f"{median(c):.2f}" for c in columns)
        lines.append(f"| {name} | {len(mine)} | {words} |")
    return "\n".join(lines)


def within(found: list[Row], index: int, aim: float, shaft: bool) -> str:
    """In how many rows K3 (index 2) or K3/K1 (3) is as near to the catalogue as that."""
    ratios = [r.over(r.with_shaft if shaft else r.alone)[index] for r in found]
    known = [x for x in ratios if x is not None]
    return f"{sum(abs(x - 1) <= aim for x in known)} of {len(known)}"


Change = Callable[[Design, GearModel], GearModel]
THIN = {"flexspline.ring_thickness_mm": 0.5, "wave_generator.race_thickness_mm": 0.5}
"""Ring and race half as thick."""
THICK_WALL = {
    "flexspline.wall_thickness_mm": 0.02 / WALL_SHARE,
    "flexspline.diaphragm_thickness_mm": 0.02 / WALL_SHARE,
}
"""As in examples/xb1-40.toml: 0.02 and 0.03 of the pitch radius."""


def proportion(key: str, factor: float = STEP) -> Change:
    """A value of the design file times a factor."""
    return proportions({key: factor})


def proportions(factors: Mapping[str, float]) -> Change:
    """Values of the design file times their factors; the ring keeps its root."""

    def changed(design: Design, _: GearModel) -> GearModel:
        new = {key: stated(design, key) * factor for key, factor in factors.items()}
        ring = "flexspline.ring_thickness_mm"
        if len(new) > 1 and ring in new:
            less = stated(design, ring) - new[ring]
            new["flexspline.inner_diameter_mm"] = design.flexspline.inner_diameter_mm + 2 * less
        other = design.changed(new)
        return gear_model(other, other.part("flexspline"))

    return changed


def stated(design: Design, key: str) -> float:
    """A value of the design file, or what the program assumes for it."""
    table, name = key.split(".")
    value = getattr(getattr(design, table), name)
    if value is None:
        value = next(a.value for a in gear_assumptions(design) if a.key == key)
    return float(value)


def setting(key: str, value: object) -> Change:
    """Another value of the design file."""

    def changed(design: Design, _: GearModel) -> GearModel:
        other = design.changed({key: value})
        return gear_model(other, other.part("flexspline"))

    return changed


CHANGES: tuple[tuple[str, Change], ...] = (
    *(
        (f"`{key}` × {STEP:g}", proportion(key))
        for key in (
            "flexspline.wall_thickness_mm",
            "flexspline.ring_thickness_mm",
            "flexspline.length_mm",
            "flexspline.ring_width_mm",
            "flexspline.diaphragm_thickness_mm",
            "flexspline.boss_diameter_mm",
            "wave_generator.race_thickness_mm",
            "gear.pressure_angle_deg",
        )
    ),
    ("`wave_generator.ball_diameter_mm` / 1.2", proportion("wave_generator.ball_diameter_mm", 1 / STEP)),
    ("`wave_generator.deflection_mm` × 1.05", proportion("wave_generator.deflection_mm", 1.05)),
    ("18 balls for 23", lambda d, m: replace(m, wave_generator=replace(m.wave_generator, balls=18))),
    ("no bearing play", lambda d, m: replace(m, wave_generator=replace(m.wave_generator, play=0.0))),
    ("rigid plug for race and balls", lambda d, m: replace(m, race=None)),
    (
        "`gear.pressure_angle_deg` 30 for 20",
        proportion("gear.pressure_angle_deg", 1.5),
    ),
    ("teeth three times softer", lambda d, m: replace(m, pair=3 * m.pair)),
    ("straight teeth along the face", setting("gear.tooth_face", "straight")),
    ("rigid circular spline", lambda d, m: replace(m, spline=None)),
    (
        "`gear.circular_spline_diameter_mm` / 1.1",
        proportion("gear.circular_spline_diameter_mm", 1 / 1.1),
    ),
    ("wall and diaphragm of `examples/xb1-40.toml`, × 1.63", proportions(THICK_WALL)),
    ("ring and race × 0.5", proportions(THIN)),
    ("ring and race × 0.5, pressure angle 30", proportions(THIN | {"gear.pressure_angle_deg": 1.5})),
    ("plain flanks", lambda d, m: replace(m, mesh=replace(m.mesh, flanks="plain"))),
    ("conjugate flanks", lambda d, m: replace(m, mesh=replace(m.mesh, flanks="conjugate"))),
    ("working depth 1.0 strokes for 1.34", lambda d, m: replace(m, mesh=replace(m.mesh, depth=1.0))),
)  # fmt: skip


def sensitivity(size: float, ratio: int, torques: tuple[float, ...]) -> str:
    """K1, K2, K3 with one assumption changed over those without, the largest change first."""
    design = sized_design(size, ratio).changed({"flexspline.bolt_count": 0})
    own = gear_model(design, design.part("flexspline"))
    base = np.array(slopes(Chain(own, 0.0, 0.0), torques))
    found = [
        (name, np.array(slopes(Chain(change(design, own), 0.0, 0.0), torques)) / base)
        for name, change in CHANGES
    ]
    shaft = 1 / revolved.stiffness(design, "shaft", RELATIVE_WIDTH).K_Nm_per_rad
    found.append(("with its shaft", np.array(slopes(Chain(own, shaft, 0.0), torques)) / base))
    found.sort(key=lambda each: -float(np.abs(np.log(each[1])).max()))
    return "\n".join(f"| {name} | {' | '.join(f'{x:.2f}' for x in r)} |" for name, r in found)


def examples() -> tuple[str, str]:
    """Tables of the two examples: K and shares; the four terms beside the model."""
    first, second = [], []
    for name in ("xb1-40", "hat-25"):
        context = analysis_context(load_design(ROOT / "examples" / f"{name}.toml"))
        chain = chain_of(context)
        curve = curve_of(context.design, chain)
        first.append(f"| {name} | {_figures(curve)} |")
        second.append(
            four_terms(
                name, context.design, chain, part_stiffness(context.part("flexspline")).K_Nm_per_rad
            )
        )
    return "\n".join(first), "\n".join(second)


def _figures(curve: GearCurve) -> str:
    shares = " / ".join(f"{100 * v:.0f}" for v in curve.compliance_shares.values())
    K = (curve.K1_Nm_per_rad, curve.K2_Nm_per_rad, curve.K3_Nm_per_rad)
    three_digits = " | ".join(format(float(format(k, ".3g")), ".0f") for k in K)
    return (
        f"{curve.rated_torque_Nm:.3g} | {three_digits} | {K[2] / K[0]:.2f} | "
        f"{curve.lost_motion_arcsec:.0f} | {curve.teeth_in_contact} | {shares}"
    )


def four_terms(name: str, design: Design, chain: Chain, K_b: float) -> str:
    """Each term of the sum at ± T_L, and what the contact model has in its place [arcsec]."""
    total = backlash(design, K_b, 1 / chain.shaft)
    load = design.load.torque_Nm
    start = chain.model.at_torque(small_torque(load, rated_torque(design)[0]))
    own = gear_terms(chain, load, start)
    lines = []
    for key, words in (
        ("shaft", "shaft, 2T/K_e"),
        ("flexspline", "flexspline, 2T/K_b; in the model with teeth and bearing"),
        ("flank_clearance", "flank clearance"),
        ("bearing_play", "bearing play"),
        (TIGHT, "gap of the tight gear: balls and rim yield, the rim is no ideal ellipse"),
        ("total", "sum"),
    ):
        theirs = 0.0 if key == TIGHT else getattr(total, f"{key}_arcsec")
        lines.append(f"| {name} | {words} | {theirs:.1f} | {round(own[key], 1) + 0.0:.1f} |")
    return "\n".join(lines)


def published_cup() -> Design:
    """R 20, t 0.4, L 30, diaphragm 2.0 held at radius 11, seat 10 wide, 200/202 teeth, E 200 GPa.

    No clearance. The module makes room for the teeth on that rim: m(z1/2 − 1.25) = 20.2 mm.
    """
    return load_design(ROOT / "examples" / "xb1-40.toml").changed({
        "flexspline.bolt_count": 0, "flexspline.inner_diameter_mm": 39.6, "flexspline.wall_thickness_mm": 0.4,
        "flexspline.ring_thickness_mm": 0.4, "flexspline.ring_width_mm": 10.0,
        "flexspline.diaphragm_thickness_mm": 2.0, "flexspline.boss_diameter_mm": 22.0,
        "flexspline.boss_thickness_mm": 2.1, "flexspline.bore_diameter_mm": 21.0,
        "flexspline.inner_fillet_mm": 0.0, "flexspline.outer_fillet_mm": 0.0,
        "material.flexspline.youngs_modulus_GPa": 200.0, "gear.module_mm": 20.2 / 98.75,
        "gear.flank_clearance_um": 0.0, "bearing.radial_clearance_um": 0.0,
    })  # fmt: skip


def published_table() -> str:
    """Tangent stiffness and the parts of it, in kN·m/rad, over the torque."""
    design = published_cup()
    model = gear_model(design, design.part("flexspline"))
    lines, last = [], None
    for torque in (1.0, 5.0, 10.0, 20.0, 40.0, 80.0, 120.0):
        at = model.at_torque(torque, last)
        last = at
        parts = model.compliance_of(at)
        total = sum(parts.values())
        K = " | ".join(f"{1e-6 / parts[k]:.1f}" for k in ("flexspline", "bearing", "teeth"))
        shares = " / ".join(
            f"{100 * parts[k] / total:.0f}" for k in ("flexspline", "bearing", "teeth")
        )
        lines.append(f"| {torque:g} | {1e-6 / total:.1f} | {K} | {shares} |")
    return "\n".join(lines)
