"""The design file's schema: frozen, strict, every key with its unit and its range.

Ranges that concern one key alone stand here and reach the JSON Schema; rules that tie several keys
together stand in `geometry.checks`.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import pi, radians
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, ValidationError

from flexspline.geometry import ranges
from flexspline.geometry.circular_spline import DEEPEST, OUTER_SHARE
from flexspline.geometry.fields import (
    MM_PER_UM,
    UM_PER_MM,
    DesignTable,
    Length,
    Micrometre,
    Percent,
    within,
)
from flexspline.geometry.material import Materials
from flexspline.geometry.part import Part
from flexspline.geometry.part_name import PartName
from flexspline.geometry.play_limit import play_limit
from flexspline.geometry.shaft_shape import Shaft
from flexspline.geometry.shapes import Flexspline
from flexspline.geometry.wave_generator import WaveGenerator


class Gear(DesignTable):
    """The two gears, their flank clearance included."""

    module_mm: Annotated[float, within(ranges.MODULE_mm)] = Field(description="mm, m")
    teeth_flexspline: int = Field(
        ge=ranges.TEETH.low, le=ranges.TEETH.high, description="number of teeth, z1"
    )
    teeth_circular_spline: int = Field(
        ge=ranges.TEETH.low + 1,
        le=ranges.TEETH.high,
        description="number of teeth, z2; z2 - z1 is even (two lobes)",
    )
    pressure_angle_deg: Annotated[float, within(ranges.PRESSURE_ANGLE_deg)] = Field(
        description="deg, α"
    )
    flank_clearance_um: Micrometre = Field(description="µm, j_bn0, along the flank's normal")
    rated_torque_Nm: Annotated[float, within(ranges.TORQUE_Nm)] | None = Field(
        default=None, description="N·m, T_N; default in proportion to the pitch radius cubed"
    )
    flanks: Literal["relieved", "plain", "conjugate", "drawn"] = Field(
        default="relieved",
        description="of the teeth, in the whole gear: relieved, plain (straight), conjugate or drawn",
    )
    tooth_face: Literal["relieved", "straight"] = Field(
        default="relieved",
        description="along the teeth, in the whole gear: relieved for the rim's cone, or straight",
    )
    working_depth_mm: Length | None = Field(
        default=None,
        description=f"mm, radial withdrawal at which teeth disengage; default {DEEPEST:g} m(z2 - z1)/2",
    )
    circular_spline_diameter_mm: Length | None = Field(
        default=None, description=f"mm, outside of its rim; default {OUTER_SHARE:g} pitch diameters"
    )

    @property
    def flank_clearance_mm(self) -> float:
        """j_bn0 [mm]."""
        return self.flank_clearance_um * MM_PER_UM

    @property
    def tooth_thickness_mm(self) -> float:
        """πm/2 [mm]: half the pitch, on the pitch circle."""
        return pi * self.module_mm / 2

    @property
    def pitch_radius_mm(self) -> float:
        """m z1/2 [mm], of the flexspline."""
        return self.module_mm * self.teeth_flexspline / 2

    @property
    def circular_spline_pitch_radius_mm(self) -> float:
        """m z2/2 [mm], of the circular spline."""
        return self.module_mm * self.teeth_circular_spline / 2

    @property
    def more_teeth(self) -> int:
        """z2 − z1."""
        return self.teeth_circular_spline - self.teeth_flexspline

    @property
    def centre_distance_mm(self) -> float:
        """a = m(z2 − z1)/2 [mm], which is also w0, the wave generator's radial stroke."""
        return self.module_mm * self.more_teeth / 2

    @property
    def ratio(self) -> float:
        """z1/(z2 − z1): of the gear whose circular spline is held."""
        return self.teeth_flexspline / self.more_teeth

    @property
    def bearing_play_limit_um(self) -> float:
        """c_max [µm]: as far as the involute model goes."""
        return play_limit(UM_PER_MM * self.centre_distance_mm, radians(self.pressure_angle_deg))


class Bearing(DesignTable):
    """The flexible bearing of the wave generator, and how its play opens the mesh."""

    radial_clearance_um: Micrometre = Field(description="µm, c, radial internal clearance")
    bearing_play_model: Literal["involute", "small_displacement"] = Field(
        default="involute", description="involute (c up to c_max) or small_displacement (c·sin α)"
    )

    @property
    def radial_clearance_mm(self) -> float:
        """c [mm]."""
        return self.radial_clearance_um * MM_PER_UM


class Load(DesignTable):
    """The torque at which the backlash is measured."""

    torque_Nm: Annotated[float, within(ranges.TORQUE_Nm)] = Field(description="N·m, T_L, each way")


class Uncertainty(DesignTable):
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


class Solver(DesignTable):
    """How K is computed; all optional."""

    model: Literal["axisymmetric", "solid", "auto"] = Field(
        default="auto", description="axisymmetric (bodies of revolution only), solid or auto"
    )
    mesher: Literal["auto", "swept", "tetwild"] = Field(
        default="auto",
        description="of solid models: swept (from the meridian), tetwild (fTetWild), or auto",
    )
    load_case: Literal["uniform", "lobes"] = Field(
        default="uniform", description="uniform or lobes: which K_b enters the sum"
    )
    tolerance_pct: Annotated[float, within(ranges.TOLERANCE_pct)] = Field(
        default=0.5, description="%, wanted error of K"
    )
    edge_length_mm: Annotated[float, within(ranges.EDGE_mm)] | None = Field(
        default=None, description="mm, fixes the first solid mesh"
    )

    @property
    def tolerance(self) -> float:
        """Wanted error of K, as a fraction."""
        return self.tolerance_pct / 100

    @property
    def K_b_in_sum(self) -> Literal["K_b", "K_b_lobes"]:
        """Name of the K_b that enters the backlash sum."""
        return "K_b_lobes" if self.sum_at_lobes else "K_b"

    @property
    def sum_at_lobes(self) -> bool:
        """Whether the backlash sum takes the K_b of a torque that enters at the lobes: it needs the rim."""
        return self.load_case == "lobes"


def _without_examples(schema: dict[str, Any]) -> None:
    """Readers of the JSON Schema write no Python."""
    schema["description"] = schema["description"].partition("\n")[0]


class Design(DesignTable):
    """One strain wave gear: flexspline, output shaft, materials, gear, play, load.

    Examples
    --------
    >>> from flexspline import load_design
    >>> design = load_design("examples/xb1-40.toml")
    >>> design.gear.module_mm, design.gear.teeth_flexspline, design.gear.teeth_circular_spline
    (0.2, 200, 202)
    >>> design.flexspline.inner_radius, round(design.w0_mm, 3)
    (19.2, 0.2)
    """

    model_config = ConfigDict(json_schema_extra=_without_examples)

    name: str = Field(min_length=1, max_length=200, description="of the design, for the report")
    flexspline: Annotated[Flexspline, Field(discriminator="kind")]
    shaft: Shaft
    material: Materials
    gear: Gear
    bearing: Bearing
    wave_generator: WaveGenerator = WaveGenerator()
    load: Load
    uncertainty: Uncertainty = Uncertainty()
    solver: Solver = Solver()

    def __init__(self, /, **tables: Any) -> None:
        """Of a design file's tables; the rules that tie several keys together are `geometry.checks`'.

        Raises
        ------
        DesignError : unknown, missing or wrong key; its `__cause__` is pydantic's error.
        """
        try:
            super().__init__(**tables)
        except ValidationError as fault:
            from flexspline.geometry.plain_words import translate  # which reads the schema

            raise translate(fault, tables) from fault

    @property
    def w0_mm(self) -> float:
        """w0 of the wave generator's ellipse w0 cos 2φ [mm]: as stated, else m(z2 − z1)/2."""
        stated = self.wave_generator.deflection_mm
        return self.gear.centre_distance_mm if stated is None else stated

    def part(self, name: PartName) -> Part:
        """The flexspline or the shaft."""
        if name == "shaft":
            return Part(self.shaft, self.material.of_shaft)
        return Part(self.flexspline, self.material.flexspline)

    @property
    def parts(self) -> tuple[Part, Part]:
        """Flexspline and shaft."""
        return self.part("flexspline"), self.part("shaft")

    @property
    def tables(self) -> dict[str, Any]:
        """As a design file's tables, plain values without what is absent; new ones each time."""
        return self.model_dump(mode="json", exclude_none=True)

    @property
    def toml(self) -> str:
        """Text of a design file that loads as exactly this design, every key with its meaning."""
        from flexspline.geometry.template import design_text  # which describes designs

        return design_text(self)

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
