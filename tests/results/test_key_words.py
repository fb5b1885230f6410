"""Design keys in words and with their unit: the same in the form, the report, studies and diagnoses."""

import pytest

from flexspline.geometry.schema import key_words
from flexspline.results.diagnosis.channels import channel_words
from flexspline.results.study.labels import axis_label


@pytest.mark.parametrize(
    ("key", "words", "unit"),
    [
        ("flexspline.bolt_count", "flexspline bolt count", ""),
        ("bearing.radial_clearance_um", "bearing radial clearance", "µm"),
        ("density_kg_per_m3", "density", "kg/m³"),
        ("poissons_ratio", "Poisson's ratio", ""),
        ("youngs_modulus_GPa", "Young's modulus", "GPa"),
    ],
)
def test_a_key_in_words(key: str, words: str, unit: str) -> None:
    assert key_words(key) == (words, unit)


@pytest.mark.parametrize(
    ("key", "label"),
    [
        ("flexspline.wall_thickness_mm", "wall thickness in mm"),
        ("shaft.bolt_count", "shaft bolt count"),
        ("material.flexspline.density_kg_per_m3", "density in kg/m³"),
        ("material.shaft.youngs_modulus_GPa", "Young's modulus of the shaft in GPa"),
        ("material.bearing.poissons_ratio", "Poisson's ratio of the bearing"),
    ],
)
def test_a_dimension_of_a_study(key: str, label: str) -> None:
    assert axis_label(key) == label


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("shaft.bolt_count", "shaft bolt count"),
        ("material.flexspline.poissons_ratio", "material flexspline Poisson's ratio"),
    ],
)
def test_a_dimension_that_specimens_vary(key: str, words: str) -> None:
    assert channel_words(key) == words
