"""The design file's schema: frozen, strict, every key with its unit and its range.

Ranges that concern one key alone stand here and reach the JSON Schema; rules that tie several keys
together stand in `geometry.checks`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, pi, radians, sin
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from flexspline.geometry import ranges

SMALLEST_MM = ranges.LENGTH_mm.low
STEEL_KG_PER_M3 = 7850.0
"""Density where the file states none: that of steel."""


def _zero_or_visible(value: float) -> float:
    if 0 < value < SMALLEST_MM:
        raise ValueError(f"must be 0 or at least {SMALLEST_MM}")
    return value


def _within(range_: ranges.Range, description: str | None = None) -> Any:
    """A field's limits."""
    return Field(ge=range_.low, le=range_.high, allow_inf_nan=False, description=description)


Length = Annotated[float, _within(ranges.LENGTH_mm, "mm")]
LengthOrZero = Annotated[
    float,
    Field(
        ge=0,
        le=ranges.LENGTH_mm.high,
        allow_inf_nan=False,
        description="mm",
        json_schema_extra={"anyOf": [{"const": 0}, {"minimum": SMALLEST_MM}]},
    ),
    AfterValidator(_zero_or_visible),
]
Percent = Annotated[float, Field(ge=0, le=100, allow_inf_nan=False, description="%")]
Micrometre = Annotated[float, _within(ranges.CLEARANCE_um, "µm")]
BoltCount = Annotated[int, Field(ge=0, le=200)]


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


@dataclass(frozen=True)
class BoltCircle:
    """Equal holes on a circle, the first at angle 0; lengths in mm."""

    count: int
    radius: float
    hole_radius: float

    @property
    def centres(self) -> list[tuple[float, float]]:
        """(x, y) of every hole's axis [mm]."""
        angles = (2 * pi * k / self.count for k in range(self.count))
        return [(self.radius * cos(a), self.radius * sin(a)) for a in angles]


class _Bolted(_Frozen):
    bolt_count: BoltCount = Field(
        default=0, description="number of bolt holes, the first at angle 0; 0: none"
    )
    bolt_circle_diameter_mm: Length | None = Field(
        default=None, description="mm, through the holes' axes"
    )
    bolt_hole_diameter_mm: Length | None = Field(default=None, description="mm, of each hole")

    @property
    def bolts(self) -> BoltCircle | None:
        """The holes; None where there are none."""
        circle, hole = self.bolt_circle_diameter_mm, self.bolt_hole_diameter_mm
        if not self.bolt_count or circle is None or hole is None:
            return None
        return BoltCircle(self.bolt_count, circle / 2, hole / 2)


class _Flexspline(_Bolted):
    inner_diameter_mm: Length = Field(description="mm, of the tube, under the wave generator")
    wall_thickness_mm: Length = Field(description="mm, of the smooth tube")
    ring_thickness_mm: Length = Field(
        description="mm, toothed ring, from inner surface to tooth root"
    )
    length_mm: Length = Field(description="mm, closed end's outer face (z = 0) to the open rim")
    ring_width_mm: Length = Field(description="mm, axial length of the toothed ring")
    ring_offset_mm: LengthOrZero = Field(
        default=0.0, description="mm, open rim to the ring's near edge"
    )
    diaphragm_thickness_mm: Length = Field(description="mm, of the closed end's thin disc")
    inner_fillet_mm: LengthOrZero = Field(
        default=0.0, description="mm, radius of the inside corner of tube and diaphragm; 0: sharp"
    )
    outer_fillet_mm: LengthOrZero = Field(
        default=0.0, description="mm, radius of the outside corner of the closed end; 0: sharp"
    )
    teeth: Literal["none", "drawn"] = Field(
        default="none",
        description="none: plain ring; drawn: a ring as stiff as the teeth and the rim under them",
    )
    tooth_flank: Literal["involute", "trapezoid"] = Field(
        default="involute", description="involute or trapezoid, where teeth are drawn"
    )

    @property
    def inner_radius(self) -> float:
        """Ri [mm]."""
        return self.inner_diameter_mm / 2

    @property
    def wall_radius(self) -> float:
        """Rw = Ri + wall [mm]."""
        return self.inner_radius + self.wall_thickness_mm

    @property
    def ring_radius(self) -> float:
        """Rr = Ri + ring [mm], the tooth root."""
        return self.inner_radius + self.ring_thickness_mm

    @property
    def ring_end(self) -> float:
        """Upper end of the toothed ring, z [mm]."""
        return self.length_mm - self.ring_offset_mm

    @property
    def ring_start(self) -> float:
        """Lower end of the toothed ring, z [mm]."""
        return self.ring_end - self.ring_width_mm

    @property
    def shoulder_start(self) -> float:
        """Where the 45° shoulder leaves the wall, z [mm]."""
        return self.ring_start - (self.ring_radius - self.wall_radius)


class Cup(_Flexspline):
    """A cup: the closed end carries a thick boss that bolts to the shaft."""

    kind: Literal["cup"] = Field(description="cup or hat")
    boss_diameter_mm: Length = Field(description="mm, thick centre that bolts to the shaft")
    boss_thickness_mm: Length = Field(description="mm, from z = 0")
    bore_diameter_mm: LengthOrZero = Field(
        default=0.0, description="mm, through hole in the boss; 0: none"
    )


class Hat(_Flexspline):
    """A hat (silk hat): the diaphragm runs outwards to a bolted flange."""

    kind: Literal["hat"] = Field(description="cup or hat")
    flange_outer_diameter_mm: Length = Field(description="mm, outside of the bolted flange")
    flange_inner_diameter_mm: Length = Field(description="mm, where the flange's thick part begins")
    flange_thickness_mm: Length = Field(description="mm, from z = 0")


class ShaftSegment(_Frozen):
    """One cylinder of the shaft; the first is the flange on the flexspline."""

    length_mm: Length = Field(description="mm, along the axis")
    outer_diameter_mm: Length = Field(description="mm, outside")
    inner_diameter_mm: LengthOrZero = Field(default=0.0, description="mm, of the bore; 0: solid")


class Keyway(_Frozen):
    """A square-ended slot from the free end, centred at angle 0."""

    width_mm: Length = Field(description="mm, across the slot")
    depth_mm: Length = Field(description="mm, flat floor below the last segment's outer radius")
    length_mm: Length = Field(description="mm, from the free end")


class Shaft(_Bolted):
    """The output shaft: segments stacked from the flange to the free end."""

    fillet_mm: LengthOrZero = Field(
        default=0.0, description="mm, radius at every inside corner where the outer diameter steps"
    )
    grip_length_mm: Length = Field(description="mm, at the free end: where the output is held")
    segment: tuple[ShaftSegment, ...] = Field(min_length=1, max_length=50, strict=False)
    keyway: Keyway | None = Field(default=None, description="optional slot from the free end")

    @property
    def length(self) -> float:
        """Total length [mm]."""
        return sum(s.length_mm for s in self.segment)


class Material(_Frozen):
    """Isotropic linear elastic material."""

    name: str = Field(min_length=1, max_length=200, description="for the report")
    youngs_modulus_GPa: Annotated[float, _within(ranges.YOUNGS_MODULUS_GPa)] = Field(
        description="GPa, E"
    )
    poissons_ratio: Annotated[float, _within(ranges.POISSONS_RATIO)] = Field(description="1, ν")
    fatigue_limit_MPa: Annotated[float, _within(ranges.FATIGUE_LIMIT_MPa)] | None = Field(
        default=None, description="MPa, optional, compared with stress"
    )
    density_kg_per_m3: Annotated[float, _within(ranges.DENSITY_kg_per_m3)] = Field(
        default=STEEL_KG_PER_M3, description="kg/m³, for the mass alone; absent: steel's 7850"
    )

    @property
    def density_stated(self) -> bool:
        """Whether the file gives the density; else it is taken for steel's."""
        return "density_kg_per_m3" in self.model_fields_set


class Materials(_Frozen):
    """What the two parts are made of."""

    flexspline: Material
    shaft: Material | None = Field(default=None, description="absent: as the flexspline's")


class Gear(_Frozen):
    """The two gears, their flank clearance included."""

    module_mm: Annotated[float, _within(ranges.MODULE_mm)] = Field(description="mm, m")
    teeth_flexspline: int = Field(
        ge=ranges.TEETH.low, le=ranges.TEETH.high, description="number of teeth, z1"
    )
    teeth_circular_spline: int = Field(
        ge=ranges.TEETH.low + 1,
        le=ranges.TEETH.high,
        description="number of teeth, z2; z2 - z1 is even (two lobes)",
    )
    pressure_angle_deg: Annotated[float, _within(ranges.PRESSURE_ANGLE_deg)] = Field(
        description="deg, α"
    )
    flank_clearance_um: Micrometre = Field(description="µm, j_bn0, along the flank's normal")

    @property
    def centre_distance_mm(self) -> float:
        """a = m(z2 − z1)/2 [mm], which is also w0, the wave generator's radial stroke."""
        return self.module_mm * (self.teeth_circular_spline - self.teeth_flexspline) / 2

    @property
    def bearing_play_limit_um(self) -> float:
        """c_max = 2a(1 − cos α) [µm]: there the working pressure angle is 0."""
        return 2e3 * self.centre_distance_mm * (1 - cos(radians(self.pressure_angle_deg)))


class Bearing(_Frozen):
    """The flexible bearing of the wave generator, and how its play opens the mesh."""

    radial_clearance_um: Micrometre = Field(description="µm, c, radial internal clearance")
    bearing_play_model: Literal["involute", "small_displacement"] = Field(
        default="involute", description="involute (c up to c_max) or small_displacement (c·sin α)"
    )


class Load(_Frozen):
    """The torque at which the backlash is measured."""

    torque_Nm: Annotated[float, _within(ranges.TORQUE_Nm)] = Field(description="N·m, T_L, each way")


class Uncertainty(_Frozen):
    """One standard deviation each: what the prediction may be off by with nothing wrong with it.

    0, as absent, states nothing: no dimension is exact.
    """

    youngs_modulus_pct: Percent = Field(
        default=0.0, description="%, of E, flexspline and shaft alike; 0: not stated"
    )
    flank_clearance_um: Micrometre = Field(default=0.0, description="µm, of j_bn0; 0: not stated")
    radial_clearance_um: Micrometre = Field(default=0.0, description="µm, of c; 0: not stated")

    @property
    def stated(self) -> tuple[str, ...]:
        """The sources of doubt that have a standard deviation: their keys without unit."""
        return tuple(key.rpartition("_")[0] for key, std in self if std > 0)


class Solver(_Frozen):
    """How K is computed; all optional."""

    model: Literal["axisymmetric", "solid", "auto"] = Field(
        default="auto", description="axisymmetric (bodies of revolution only), solid or auto"
    )
    load_case: Literal["uniform", "lobes"] = Field(
        default="uniform", description="uniform or lobes: which K_b enters the sum"
    )
    tolerance_pct: Annotated[float, _within(ranges.TOLERANCE_pct)] = Field(
        default=0.5, description="%, wanted error of K"
    )
    edge_length_mm: Annotated[float, _within(ranges.EDGE_mm)] | None = Field(
        default=None, description="mm, fixes the first solid mesh"
    )


class Design(_Frozen):
    """One strain wave gear: flexspline, output shaft, materials, gear, play, load."""

    name: str = Field(min_length=1, max_length=200, description="of the design, for the report")
    flexspline: Annotated[Cup | Hat, Field(discriminator="kind")]
    shaft: Shaft
    material: Materials
    gear: Gear
    bearing: Bearing
    load: Load
    uncertainty: Uncertainty = Uncertainty()
    solver: Solver = Solver()

    @property
    def shaft_material(self) -> Material:
        return self.material.shaft or self.material.flexspline

    def changed(self, values: Mapping[str, object]) -> Design:
        """A new, checked design with other values at some dotted keys; array elements count from 0.

        Raises
        ------
        DesignError : no such key, a value out of range, or impossible geometry.

        Examples
        --------
        >>> from flexspline import load_design
        >>> longer = load_design("examples/xb1-40.toml").changed({"flexspline.length_mm": 35.0})
        >>> longer.flexspline.length_mm
        35.0
        """
        from flexspline.geometry.keys import with_values  # which makes designs

        return with_values(self, values)

    def material_of(self, part: str) -> Material:
        """What ``"flexspline"`` or ``"shaft"`` is made of."""
        return self.shaft_material if part == "shaft" else self.material.flexspline
