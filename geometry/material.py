"""Materials of the parts."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, SerializerFunctionWrapHandler, model_serializer

from flexspline.geometry import ranges
from flexspline.geometry.fields import DesignTable, within

STEEL_KG_PER_M3 = 7850.0
"""Density where the file states none: that of steel."""


class ElasticMaterial(DesignTable):
    """Isotropic linear elastic material."""

    name: str = Field(
        default="not named", min_length=1, max_length=200, description="for the report"
    )
    youngs_modulus_GPa: Annotated[float, within(ranges.YOUNGS_MODULUS_GPa)] = Field(
        description="GPa, E"
    )
    poissons_ratio: Annotated[float, within(ranges.POISSONS_RATIO)] = Field(
        default=0.3, description="1, ν; default 0.3, of metals"
    )

    @property
    def youngs_modulus_MPa(self) -> float:
        """E, in the unit of stress."""
        return self.youngs_modulus_GPa * 1e3


class Material(ElasticMaterial):
    """Elastic constants, fatigue limit and density."""

    name: str = Field(min_length=1, max_length=200, description="for the report")
    poissons_ratio: Annotated[float, within(ranges.POISSONS_RATIO)] = Field(description="1, ν")
    fatigue_limit_MPa: Annotated[float, within(ranges.FATIGUE_LIMIT_MPa)] | None = Field(
        default=None, description="MPa, optional, compared with stress"
    )
    density_kg_per_m3: Annotated[float, within(ranges.DENSITY_kg_per_m3)] = Field(
        default=STEEL_KG_PER_M3, description="kg/m³, for the mass only; default: steel's 7850"
    )

    @property
    def density_stated(self) -> bool:
        """Whether the file gives the density; else it is taken for steel's."""
        return "density_kg_per_m3" in self.model_fields_set

    @model_serializer(mode="wrap")
    def as_stated(self, dumped: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """A density that the file does not give is not stated by what is made of it either."""
        tables = dict(dumped(self))
        if not self.density_stated:
            tables.pop("density_kg_per_m3", None)  # may be excluded
        return tables


BEARING_STEEL = ElasticMaterial(name="100Cr6", youngs_modulus_GPa=208.0, poissons_ratio=0.3)
"""Of races and balls where the file states none (makers' data sheets)."""


class Materials(DesignTable):
    """What the parts are made of."""

    flexspline: Material
    shaft: Material | None = Field(default=None, description="default: the flexspline's")
    circular_spline: ElasticMaterial | None = Field(
        default=None, description="of the whole gear; default: the flexspline's"
    )
    bearing: ElasticMaterial | None = Field(
        default=None,
        description=f"of races and balls in the whole gear; default: {BEARING_STEEL.name}",
    )

    @property
    def stated(self) -> dict[str, ElasticMaterial]:
        """By key."""
        return {key: value for key, value in self if value is not None}

    @property
    def of_shaft(self) -> Material:
        """As stated, else the flexspline's."""
        return self.shaft or self.flexspline

    @property
    def of_circular_spline(self) -> ElasticMaterial:
        """As stated, else the flexspline's."""
        return self.circular_spline or self.flexspline

    @property
    def of_bearing(self) -> ElasticMaterial:
        """Of races and balls: as stated, else the steel of bearings."""
        return self.bearing or BEARING_STEEL
