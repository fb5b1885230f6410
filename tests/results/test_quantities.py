"""The table of quantities against the contract's result.json, and how it prints numbers."""

import json

import pytest

from flexspline.results.quantities import QUANTITIES, THIN, grouped, quantity

# the example of the contract, section 2, with its values left out
CONTRACT = json.loads("""
{"design": "", "version": "",
 "K_b_Nm_per_rad": 0, "K_b_bounds_Nm_per_rad": 0,
 "K_b_lobes_Nm_per_rad": 0, "K_b_lobes_unsupported_Nm_per_rad": 0,
 "K_e_Nm_per_rad": 0, "K_e_bounds_Nm_per_rad": 0, "K_series_Nm_per_rad": 0,
 "wave_generator_peak_mises_MPa": 0, "torque_peak_mises_MPa": 0,
 "backlash_arcsec": {"shaft": 0, "flexspline": 0, "flank_clearance": 0, "bearing_play": 0,
                     "total": 0, "std": 0},
 "solver": {"model": "", "elements": 0, "dofs": 0, "wall_s": 0, "symmetry": ""}}
""")
SUFFIXES = {
    "N·m/rad": "_Nm_per_rad", "MPa": "_MPa", "arcsec": "_arcsec", "s": "_s", "mm": "_mm", "%": "_pct",
    "g": "_g", "N·m": "_Nm",
}  # fmt: skip


def flat(record, prefix=""):
    for key, value in record.items():
        if isinstance(value, dict):
            yield from flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key


def test_every_key_of_the_contract_stands_in_the_table_once():
    keys = [q.key for q in QUANTITIES]
    assert len(keys) == len(set(keys))
    assert set(flat(CONTRACT)) <= set(keys)


def test_columns_are_distinct_and_carry_their_unit():
    columns = [q.column for q in QUANTITIES]
    assert len(columns) == len(set(columns))
    for q in QUANTITIES:
        if q.unit:
            assert q.column.endswith(SUFFIXES[q.unit])
        assert q.name


def test_unknown_key_is_refused():
    with pytest.raises(KeyError):
        quantity("K_c_Nm_per_rad")


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [
        (44712.34, 0, f"44{THIN}712"),
        (9999.4, 0, "9999"),
        (1234567.0, 1, f"1{THIN}234{THIN}567.0"),
        (-3.25, 1, "−3.2"),
        (-0.04, 1, "0.0"),
    ],
)
def test_grouping(value, decimals, text):
    assert grouped(value, decimals) == text


def test_significant_digits_and_units():
    assert quantity("torque_peak_mises_MPa").with_unit(451.27) == f"451{THIN}MPa"
    assert quantity("torque_peak_mises_MPa").text(3.21829) == "3.22"
    assert quantity("K_e_Nm_per_rad").text(893.1249) == "893.12"


def test_unequal_bounds_print_unequal():
    text = quantity("K_b_Nm_per_rad").range_text(44712.31, 44712.38)
    low, high = text.split(" to ")
    assert low != high
    assert quantity("K_b_Nm_per_rad").range_text(5.0, 5.0) == "5.0000 to 5.0000"
