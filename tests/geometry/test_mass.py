"""Masses: each part of its own material's density, against the CAD kernel's volume."""

from __future__ import annotations

import pytest
from cad_volume import VOLUME
from example_files import EXAMPLES

from flexspline.geometry.cad import build_solid
from flexspline.geometry.load import load_design
from flexspline.geometry.mass import masses

TITANIUM, ALUMINIUM = 4430.0, 2700.0
SHAFT = {
    "name": "EN AW-6082",
    "youngs_modulus_GPa": 70.0,
    "poissons_ratio": 0.33,
    "density_kg_per_m3": ALUMINIUM,
}


@pytest.mark.parametrize("example", ["xb1-40", "hat-25", "keyed-shaft"])
def test_mass_is_the_solids_volume_times_each_parts_density(example: str) -> None:
    design = load_design(EXAMPLES / f"{example}.toml").changed(
        {"material.flexspline.density_kg_per_m3": TITANIUM, "material.shaft": SHAFT}
    )
    found = masses(design)
    grams = {
        part: build_solid(design.part(part)).Volume() * density * 1e-6  # mm³ of kg/m³
        for part, density in (("flexspline", TITANIUM), ("shaft", ALUMINIUM))
    }
    assert found.flexspline_g == pytest.approx(grams["flexspline"], rel=VOLUME)
    assert found.shaft_g == pytest.approx(grams["shaft"], rel=VOLUME)
    assert all(part.material.density_stated for part in design.parts)


def test_a_density_that_is_not_stated_is_steels_and_says_so() -> None:
    plain = load_design(EXAMPLES / "xb1-40.toml")
    assert [part.material.density_kg_per_m3 for part in plain.parts] == [7850.0, 7850.0]
    assert not any(part.material.density_stated for part in plain.parts)
    longer = plain.changed({"flexspline.length_mm": 35.0})
    assert not any(part.material.density_stated for part in longer.parts)
    # the shaft's material is the flexspline's where it has none of its own, density included
    light = plain.changed({"material.flexspline.density_kg_per_m3": 4430.0})
    assert masses(light).shaft_g == pytest.approx(masses(plain).shaft_g * 4430 / 7850, rel=1e-12)
    assert light.part("shaft").material.density_stated
