"""The design file's schema: frozen, strict, every key with its unit and its range.

Ranges that concern one key alone stand here and reach the JSON Schema; rules that tie several keys
together stand in `geometry.checks`.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Length = Annotated[float, Field(gt=0, le=10_000, allow_inf_nan=False, description="mm")]
LengthOrZero = Annotated[float, Field(ge=0, le=10_000, allow_inf_nan=False, description="mm")]
Percent = Annotated[float, Field(ge=0, le=100, allow_inf_nan=False, description="%")]
Micrometre = Annotated[float, Field(ge=0, le=10_000, allow_inf_nan=False, description="µm")]
BoltCount = Annotated[int, Field(ge=0, le=200, description="0: no holes")]


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class _Bolted(_Frozen):
    bolt_count: BoltCount = 0
    bolt_circle_diameter_mm: Length | None = None
    bolt_hole_diameter_mm: Length | None = None


class _Flexspline(_Bolted):
    inner_diameter_mm: Length = Field(description="mm, of the tube, under the wave generator")
    wall_thickness_mm: Length = Field(description="mm, smooth tube")
    ring_thickness_mm: Length = Field(description="mm, toothed ring, inner surface to tooth root")
    length_mm: Length = Field(description="mm, closed end's outer face (z = 0) to the open rim")
    ring_width_mm: Length = Field(description="mm, axial length of the toothed ring")
    ring_offset_mm: LengthOrZero = Field(0.0, description="mm, open rim to the ring's near edge")
    diaphragm_thickness_mm: Length
    inner_fillet_mm: LengthOrZero = Field(0.0, description="mm, inside corner of tube and diaphragm")
    outer_fillet_mm: LengthOrZero = Field(0.0, description="mm, outside corner of the closed end")

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


class Cup(_Flexspline):
    """A cup: the closed end carries a thick boss that bolts to the shaft."""

    kind: Literal["cup"]
    boss_diameter_mm: Length
    boss_thickness_mm: Length
    bore_diameter_mm: LengthOrZero = Field(0.0, description="mm, through hole in the boss")


class Hat(_Flexspline):
    """A hat (silk hat): the diaphragm runs outwards to a bolted flange."""

    kind: Literal["hat"]
    flange_outer_diameter_mm: Length
    flange_inner_diameter_mm: Length
    flange_thickness_mm: Length


class ShaftSegment(_Frozen):
    length_mm: Length
    outer_diameter_mm: Length
    inner_diameter_mm: LengthOrZero = Field(0.0, description="mm; 0 is solid")


class Keyway(_Frozen):
    """A square-ended slot from the free end, centred at angle 0."""

    width_mm: Length
    depth_mm: Length
    length_mm: Length


class Shaft(_Bolted):
    fillet_mm: LengthOrZero = Field(0.0, description="mm, at inside corners of the outer diameter")
    grip_length_mm: Length = Field(description="mm at the free end: where the output is held")
    segment: tuple[ShaftSegment, ...] = Field(min_length=1, max_length=50, strict=False)
    keyway: Keyway | None = None

    @property
    def length(self) -> float:
        """Total length [mm]."""
        return sum(s.length_mm for s in self.segment)


class Material(_Frozen):
    name: str = Field(min_length=1, max_length=200)
    youngs_modulus_GPa: float = Field(gt=0, le=2000, allow_inf_nan=False)
    poissons_ratio: float = Field(ge=0, le=0.49, allow_inf_nan=False)
    fatigue_limit_MPa: float | None = Field(None, gt=0, le=1e5, allow_inf_nan=False)


class Materials(_Frozen):
    flexspline: Material
    shaft: Material | None = Field(None, description="absent: the flexspline's")


class Gear(_Frozen):
    module_mm: float = Field(gt=0, le=100, allow_inf_nan=False)
    teeth_flexspline: int = Field(ge=10, le=10_000, description="z1")
    teeth_circular_spline: int = Field(ge=11, le=10_000, description="z2")
    pressure_angle_deg: float = Field(ge=5, le=45, allow_inf_nan=False)
    flank_clearance_um: Micrometre = Field(description="µm, j_bn0, normal")


class Bearing(_Frozen):
    radial_clearance_um: Micrometre = Field(description="µm, c")
    bearing_play_model: Literal["involute", "small_displacement"] = "involute"


class Load(_Frozen):
    torque_Nm: float = Field(gt=0, le=1e6, allow_inf_nan=False, description="N·m, T_L")


class Uncertainty(_Frozen):
    """One standard deviation each: what the prediction may be off by with nothing wrong with it."""

    youngs_modulus_pct: Percent = 0.0
    flank_clearance_um: Micrometre = 0.0
    radial_clearance_um: Micrometre = 0.0


class Solver(_Frozen):
    model: Literal["axisymmetric", "solid", "auto"] = "auto"
    load_case: Literal["uniform", "lobes"] = "uniform"
    tolerance_pct: float = Field(0.5, ge=0.01, le=20, allow_inf_nan=False)
    edge_length_mm: float | None = Field(
        None, gt=0, le=1000, allow_inf_nan=False, description="mm, fixes the first solid mesh"
    )


class Design(_Frozen):
    """One strain wave gear: flexspline, output shaft, materials, gear, play, load."""

    name: str = Field(min_length=1, max_length=200)
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
