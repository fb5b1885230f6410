"""Source: "Comprehensive Analysis and Modeling of Backlash in Strain Wave Gears" (web article).

Its tables 2 to 5 and each printed line that does not hold, recomputed. Angles in arcsec, clearances
in µm, as there. Nominal gear (section 3.2): m = 0.2 mm, z = 200/202, α = 20°, T_L = 0.5 N·m.
"""

from __future__ import annotations

import csv
from math import acos, cos, degrees, pi, radians, sin, tan

import pytest
from example_files import EXAMPLES

from flexspline.geometry.play_limit import play_limit
from flexspline.pipeline.backlash import ARCSEC_PER_RAD, gap_angle, windup
from flexspline.pipeline.bearing_play import (
    BearingPlayDomainError,
    involute_clearance,
    involute_clearance_slope,
    small_displacement_clearance,
    working_pressure_angle,
)

M, Z1, Z2, ALPHA, TORQUE = 0.2, 200, 202, radians(20), 0.5
A = M * (Z2 - Z1) / 2
C_MAX = 2 * A * (1 - cos(ALPHA))
PRINTED = 0.05 + 1e-9
"""The tables print one decimal: half of the last one."""
ARTICLE, BY_HAND = "the article's print", "recomputed by hand"
MEASURED = EXAMPLES / "measured/size-40-end-points.csv"


def inv(x: float) -> float:
    return tan(x) - x


def compliance(stiffness: float) -> float:
    return windup(TORQUE, stiffness) * ARCSEC_PER_RAD


def flank(j_um: float) -> float:
    return gap_angle(j_um * 1e-3, M, Z1, ALPHA) * ARCSEC_PER_RAD


def play_um(c_um: float) -> float:
    return involute_clearance(c_um * 1e-3, A, ALPHA) * 1e3


def unit_readings() -> dict[str, tuple[float, float]]:
    lines = [x for x in MEASURED.read_text(encoding="utf-8").splitlines() if x[0] != "#"]
    return {
        row["unit"]: (float(row["angle_plus_arcsec"]), float(row["angle_minus_arcsec"]))
        for row in csv.DictReader(lines)
    }


@pytest.mark.parametrize(
    ("stiffness", "printed", "exact"),
    [(1.0e4, 20.6, 20.63), (1.8e4, 11.5, 11.46), (3.0e4, 6.9, 6.88)],
)
def test_table_2_compliance(stiffness: float, printed: float, exact: float, record) -> None:
    case = f"Table 2, wind-up at {stiffness:.0f} N·m/rad"
    record(case, ARTICLE, printed, compliance(stiffness), "″", digits=3)
    assert compliance(stiffness) == pytest.approx(printed, abs=PRINTED)
    assert compliance(stiffness) == pytest.approx(exact, abs=0.005)  # two decimals


@pytest.mark.parametrize(
    ("j", "printed", "exact"),
    [(1, 11.0, 10.98), (2, 22.0, 21.95), (3, 32.9, 32.93), (4, 43.9, 43.90), (5, 54.9, 54.88)],
)
def test_table_3_flank_clearance(j: float, printed: float, exact: float, record) -> None:
    record(f"Table 3, flank clearance {j} µm", ARTICLE, printed, flank(j), "″", digits=3)
    assert flank(j) == pytest.approx(printed, abs=PRINTED)
    assert flank(j) == pytest.approx(exact, abs=0.005)  # two decimals


TABLE_4 = [
    # c, angle printed, angle, normal j', circumferential j'/cos α, j' printed
    (5, 17.8, 17.84, 1.63, 1.73, 1.7),
    (10, 33.6, 33.63, 3.06, 3.26, 3.2),
    (15, 46.9, 46.94, 4.28, 4.55, 4.5),
    (20, 57.0, 57.04, 5.20, 5.53, 5.4),
]


@pytest.mark.parametrize(("c", "printed", "exact", "normal", "along", "_"), TABLE_4)
def test_table_4_bearing_play(
    c: float, printed: float, exact: float, normal: float, along: float, _: float, record
) -> None:
    record(f"Table 4, bearing play {c} µm", ARTICLE, printed, flank(play_um(c)), "″", digits=3)
    assert flank(play_um(c)) == pytest.approx(printed, abs=PRINTED)
    assert flank(play_um(c)) == pytest.approx(exact, abs=0.005)  # two decimals
    assert play_um(c) == pytest.approx(normal, abs=0.005)
    assert play_um(c) / cos(ALPHA) == pytest.approx(along, abs=0.005)


@pytest.mark.parametrize(("c", "printed_angle", "_", "normal", "along", "column"), TABLE_4)
def test_table_4_clearance_column_is_circumferential(
    c: float, printed_angle: float, _: float, normal: float, along: float, column: float
) -> None:
    assert abs(column - along) < abs(column - normal)
    # taken for the normal clearance, as its heading says, it does not give the printed angle
    assert abs(flank(column) - printed_angle) > 0.8
    # "~5.4" for 5.53 is more than a rounding off, the others are within "~"
    assert abs(column - along) < (0.07 if c < 20 else 0.14)


@pytest.mark.parametrize("c", [0.01, 5, 12, 20, 24])
def test_printed_form_is_negative(c: float) -> None:
    """Section 2.1 prints m(z2 − z1) cos α [inv α′ − inv α]."""
    working = acos(M * (Z2 - Z1) * cos(ALPHA) / (2 * A - c * 1e-3))
    printed = M * (Z2 - Z1) * cos(ALPHA) * (inv(working) - inv(ALPHA))
    assert working < ALPHA
    assert printed < 0
    # the sign alone differs; 1e-12 of the terms that are subtracted
    assert play_um(c) == pytest.approx(-printed * 1e3, abs=1e-12 * 1e3)


def test_domain_ends_at_c_max(record) -> None:
    limit = play_limit(A, ALPHA) * 1e3
    record("Largest bearing play the model answers for", BY_HAND, 24.12, limit, "µm")
    assert play_limit(A, ALPHA) * 1e3 == pytest.approx(24.12, abs=0.005)
    # at the end cos α′ rounds to within 1e-16 of 1, α′ to its root
    assert degrees(working_pressure_angle(C_MAX, A, ALPHA)) == pytest.approx(0, abs=1e-5)
    with pytest.raises(BearingPlayDomainError) as caught:
        working_pressure_angle(0.030, A, ALPHA)
    assert caught.value.play_um == pytest.approx(30)
    assert caught.value.limit_um == pytest.approx(24.12, abs=0.005)
    assert "30 µm" in str(caught.value)
    assert "24.12 µm" in str(caught.value)


def test_bearing_term_saturates(record) -> None:
    largest = flank(play_um(C_MAX * 1e3))
    record("Bearing term where it saturates", BY_HAND, 61.48, largest, "″")
    assert flank(play_um(C_MAX * 1e3)) == pytest.approx(61.48, abs=0.005)
    assert involute_clearance_slope(C_MAX, A, ALPHA) == pytest.approx(0, abs=1e-7)


def test_stiffness_is_of_the_two_in_series() -> None:
    """ "K_e + K_b ≈ 1.8e4" gives the printed 11.5″ only if it means the two in series."""
    K_e = K_b = 3.6e4
    series = 1 / (1 / K_e + 1 / K_b)
    assert series == pytest.approx(1.8e4)
    assert compliance(K_e) + compliance(K_b) == pytest.approx(11.5, abs=PRINTED)


@pytest.mark.parametrize("c", [5, 10, 15, 20, 24])
def test_base_widths(c: float) -> None:
    """With the right base widths the article's general expression is the positive form."""
    working = working_pressure_angle(c * 1e-3, A, ALPHA)
    rb1, rb2 = M * Z1 * cos(ALPHA) / 2, M * Z2 * cos(ALPHA) / 2

    def general(e_b2: float, s_b1: float) -> float:
        return e_b2 - s_b1 + 2 * (rb1 - rb2) * inv(working)

    s_b1 = (pi / 2 + Z1 * inv(ALPHA)) * M * cos(ALPHA)
    e_b2 = (pi / 2 + Z2 * inv(ALPHA)) * M * cos(ALPHA)
    # 1e-12 mm: widths of 1 mm are subtracted
    assert general(e_b2, s_b1) == pytest.approx(play_um(c) * 1e-3, abs=1e-12)
    printed_s = (pi / 2 + 2 * Z1 * inv(ALPHA)) * M * cos(ALPHA)
    printed_e = (pi / 2 - 2 * Z2 * inv(ALPHA)) * M * cos(ALPHA)
    # −2(z1 + z2) m cos α inv α = −2.25 mm: no clearance of a gear of module 0.2
    assert general(printed_e, printed_s) < -2


def test_without_play_both_widths_leave_no_clearance() -> None:
    assert play_um(0) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(("c", "linear"), [(5, 1.71), (10, 3.42), (15, 5.13), (20, 6.84)])
def test_small_displacement_is_larger_and_tangent(c: float, linear: float, record) -> None:
    small = small_displacement_clearance(c * 1e-3, ALPHA) * 1e3
    record(f"Flanks moved apart by {c} µm of play", "c sin α", linear, small, "µm", digits=3)
    assert small == pytest.approx(linear, abs=0.005)
    assert small > play_um(c)
    assert involute_clearance_slope(0, A, ALPHA) == pytest.approx(sin(ALPHA), rel=1e-12)


def envelope() -> tuple[float, float]:
    low = compliance(1.8e4) + flank(2) + flank(play_um(10))
    high = compliance(1.8e4) + flank(4) + flank(play_um(15))
    return low, high


def test_table_5_envelope(record) -> None:
    low, high = envelope()
    record("Table 5, lower end", ARTICLE, 67.1, low, "″", digits=3)
    record("Table 5, upper end", ARTICLE, 102.3, high, "″")
    assert low == pytest.approx(67.0, abs=PRINTED)  # printed 67.1: its terms were rounded up first
    assert high == pytest.approx(102.3, abs=PRINTED)


def test_table_5_units_2_and_3_are_outside() -> None:
    low, high = envelope()
    total = {unit: plus - minus for unit, (plus, minus) in unit_readings().items()}
    assert total == {"1": 86, "2": 104, "3": 117, "4": 92}
    assert {unit for unit, x in total.items() if not low <= x <= high} == {"2", "3"}


def test_table_5_no_clearance_within_tolerance_explains_unit_3(record) -> None:
    largest = compliance(1.8e4) + flank(4) + flank(play_um(C_MAX * 1e3))
    case = "Table 5, most that clearances explain of unit 3's 117″"
    record(case, BY_HAND, 116.8, largest, "″")
    assert largest == pytest.approx(116.8, abs=PRINTED)
    plus, minus = unit_readings()["3"]
    assert largest < plus - minus


def test_table_5_middles_are_off_centre() -> None:
    """A model symmetric in the torque predicts 0 for each."""
    middles = [(plus + minus) / 2 for plus, minus in unit_readings().values()]
    assert middles == [9.0, 2.0, -19.5, 25.0]


def test_stiffness_read_as_a_sum_gives_at_best_four_times_the_compliance() -> None:
    """Of all pairs that add up to 1.8e4 the equal one is the stiffest in series."""
    pairs = [(share * 1.8e4, (1 - share) * 1.8e4) for share in (0.1, 0.3, 0.5, 0.7, 0.9)]
    windups = [compliance(a) + compliance(b) for a, b in pairs]
    assert min(windups) == windups[2] == pytest.approx(45.84, abs=0.005)
