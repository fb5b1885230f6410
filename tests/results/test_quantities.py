"""The table of quantities against result.json of docs/contract.md, and how it prints numbers."""

import json
import re
import runpy
import tomllib
from pathlib import Path

import pytest

from flexspline.geometry.load import design_from
from flexspline.pipeline import rim_case
from flexspline.pipeline.rim_case import RIM_CASES, LoadCase
from flexspline.pipeline.stiffnesses import FIGURES
from flexspline.pipeline.study.figures import FIGURES as STUDIED
from flexspline.results import quantities
from flexspline.results.numbers import THIN, beyond
from flexspline.results.quantities import QUANTITIES, quantity

PAGE = (Path(__file__).parents[2] / "docs" / "contract.md").read_text(encoding="utf-8")
RECORD = json.loads(re.search(r"```json\n(\{\"design\".*?)```", PAGE, re.S)[1])
SUFFIXES = {
    "N·m/rad": "_Nm_per_rad", "MPa": "_MPa", "arcsec": "_arcsec", "s": "_s", "mm": "_mm", "%": "_pct",
    "g": "_g", "N·m": "_Nm", "N": "_N",
}  # fmt: skip


def flat(record, prefix=""):
    for key, value in record.items():
        if isinstance(value, dict):
            yield from flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key


def test_the_page_s_design_loads():
    """Its comments, too: the hat's keys are named there, and are another kind's."""
    design = design_from(tomllib.loads(re.search(r"```toml\n(.*?)```", PAGE, re.S)[1]))
    assert design.name == "XB1-40 cup"


def test_every_key_of_the_page_stands_in_the_table_once():
    keys = [q.key for q in QUANTITIES]
    assert len(keys) == len(set(keys))
    assert set(flat(RECORD)) <= set(keys)


@pytest.mark.parametrize("figure", FIGURES)
def test_every_stiffness_has_its_words_in_the_table(figure: str):
    """A load case without them would be solved, and neither printed nor reported."""
    assert quantity(f"{figure}_Nm_per_rad").name
    assert quantity(f"{figure}_bounds_Nm_per_rad").name


def test_a_load_case_without_words_of_its_own_is_named_by_its_title(monkeypatch):
    """`RIM_CASES` is where a load case is added: its figures are printed as soon as it is solved."""
    more = {**RIM_CASES, "one_lobe": LoadCase("torque at one lobe", None)}
    monkeypatch.setattr(rim_case, "RIM_CASES", more)
    made = {q.key: q for q in runpy.run_path(quantities.__file__)["QUANTITIES"]}
    K, bounds = (made[f"K_b_one_lobe{leaf}_Nm_per_rad"] for leaf in ("", "_bounds"))
    assert K.name == "Flexspline stiffness, torque at one lobe"
    assert bounds.name == "Bounds of the flexspline stiffness, torque at one lobe"
    assert K.symbol == bounds.symbol == "K_b,one lobe"
    assert K.mathtext == r"$K_{\mathrm{b,one\ lobe}}$"
    assert list(made).index(K.key) < list(made).index("K_e_Nm_per_rad")
    assert len(made) == len(QUANTITIES) + 2


def test_every_figure_of_a_study_stands_in_the_table():
    assert {figure.partition("[")[0] for figure in STUDIED} <= {q.key for q in QUANTITIES}


def test_keys_carry_their_unit():
    for q in QUANTITIES:
        if q.unit:
            assert any(name.endswith(SUFFIXES[q.unit]) for name in q.key.split("."))
        assert q.name


def test_unknown_key_is_refused():
    with pytest.raises(KeyError):
        quantity("K_c_Nm_per_rad")


def test_significant_digits_and_units():
    assert quantity("torque_peak_mises_MPa").with_unit(451.27) == f"451{THIN}MPa"
    assert quantity("shaft_mass_g").with_unit(192_445.0) == f"192.4{THIN}kg"
    assert quantity("shaft_mass_g").with_unit(50.693) == f"50.69{THIN}g"
    assert quantity("torque_peak_mises_MPa").text(3.21829) == "3.22"
    assert quantity("K_e_Nm_per_rad").text(893.1249) == "893.12"


def test_unequal_bounds_print_unequal():
    text = quantity("K_b_Nm_per_rad").range_text(44712.31, 44712.38)
    low, high = text.split(" to ")
    assert low != high
    assert quantity("K_b_Nm_per_rad").range_text(5.0, 5.0) == "5.0000 to 5.0000"


@pytest.mark.parametrize(
    ("value", "said"), [(0.5031, "0.503"), (0.50001, "0.50001"), (0.72, "0.72"), (0.5, "0.5")]
)
def test_what_passes_a_limit_is_not_rounded_to_it(value: float, said: str) -> None:
    """No line says that ± 0.5 % is wider than ± 0.5 %."""
    assert beyond(value, 0.5) == said
