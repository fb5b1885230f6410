"""Catalogue stiffness: the published example, lost motion, and the gain on sizes left out."""

from __future__ import annotations

import numpy as np
import pytest
from catalogue.compare import compare, lost_motion
from catalogue.soft import (
    hardening_elements,
    soft_shape,
    straight_stiffness,
    torques,
)
from catalogue.table import (
    CatalogueRow,
    read_catalogue,
    twist_rad,
)
from catalogue_page import DATA, PAGE, page

from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.history import History

ROWS = read_catalogue(DATA / "hd_torsional_stiffness.csv")


@pytest.fixture(scope="module")
def finding():
    return compare(DATA)


def row_of(size: int, ratio: str) -> CatalogueRow:
    return next(r for r in ROWS if (r.size, r.ratio_class) == (size, ratio))


def test_published_worked_example() -> None:
    """HFUS-2A engineering data 1019658, p. 24: size 32, ratio 100, 60 N·m, 7.15e-4 rad, 2.5 arcmin.

    Three and two printed digits: half of the last one.
    """
    twist = float(twist_rad(row_of(32, ">50"), 60.0))
    assert twist == pytest.approx(7.15e-4, abs=0.005e-4)
    assert twist * ARCSEC_PER_RAD / 60 == pytest.approx(2.5, abs=0.05)


def test_slopes_are_the_catalogue_s() -> None:
    row = row_of(40, "50")
    for torque, K in ((20.0, 10e4), (100.0, 14e4), (250.0, 18e4)):
        assert 1 / (twist_rad(row, torque + 0.5) - twist_rad(row, torque - 0.5)) == pytest.approx(K)


def test_rows_without_K3_are_left_out() -> None:
    """The file holds 30 rows; the seven of sizes 45 and 65 to 100, and sizes 8 and 11 at 50, have no K3."""
    assert len(ROWS) == 23
    assert (45, "50") not in {(r.size, r.ratio_class) for r in ROWS}
    assert row_of(8, "30").printed == pytest.approx((10.0, 10.0, 10.0))


def test_elastic_part_of_lost_motion() -> None:
    """SOURCES.md: 50 to 90 % of the limit of 1 arcmin."""
    found = lost_motion(DATA / "schaeffler_TPI275_RT1-H-CS_i100.csv")
    assert {m.size for m in found} == {14, 17, 20, 25}
    assert all(0.5 < m.windup_arcmin < 0.9 for m in found)
    smaller = lost_motion(DATA / "schaeffler_TPI275_RT1-H-CS_i100.csv", 0.03)
    assert smaller[0].windup_arcmin == pytest.approx(0.75 * found[0].windup_arcmin)


def test_no_straight_line_is_better_than_the_one_compared() -> None:
    row = row_of(25, "30")
    T = torques(2 * row.T2)
    K, true = straight_stiffness(row, 2 * row.T2), twist_rad(row, T)

    def error(k: float) -> float:
        return float(np.sum((T / k - true) ** 2))

    assert error(K) < min(error(1.01 * K), error(0.99 * K))


def test_elements_are_the_same_curve() -> None:
    """The extension is the cause that a sweep's diagnosis names, beside a straight line of K3."""
    row = row_of(32, ">50")
    T = np.array([5.0, 29.0, 60.0, 108.0, 200.0])
    added = known_causes()["stiffness_hardening"].angle_arcsec(
        hardening_elements(row, 216.0), History.course(T)
    )
    assert added + T / row.K[2] * ARCSEC_PER_RAD == pytest.approx(
        twist_rad(row, T) * ARCSEC_PER_RAD
    )


def test_a_size_is_not_fitted_on_itself(finding) -> None:
    """A size made absurd does not change its own prediction's shape."""
    mine = next(r for r in finding.rows if (r.row.size, r.row.ratio_class) == (25, "50"))
    others = [r for r in ROWS if r.ratio_class == "50" and r.size != 25]
    shape = soft_shape(others)
    assert mine.soft.K[2] / mine.soft.K[0] == pytest.approx(shape.K3_over_K1)
    assert straight_stiffness(mine.soft, 2 * mine.row.T2) == pytest.approx(mine.straight_K)


def test_gain_on_sizes_left_out(finding) -> None:
    """The floor is rounding; every size of 14 and more gains at least half, sizes 8 and 11 less surely."""
    gain = finding.gain
    assert gain.noise_floor < gain.rmse_after < 0.3 * gain.rmse_calibrated
    for r in finding.rows:
        assert r.soft_pct < r.line_pct
        if r.row.size >= 14:
            assert r.soft_pct < r.line_pct / 2


def test_booked_clearance_is_refuted(finding) -> None:
    limited = [r for r in finding.rows if r.limit_arcmin is not None]
    assert {r.limit_arcmin for r in limited} == {1.0}
    assert len(limited) == 21  # sizes 8 and 11 have no stated limit
    assert all(r.refuted for r in limited)
    # by hand, size 14 ratio 50: 2/3400 + 4.9/4700 − 6.9/5700 = 4.203e-4 rad, twice, in arcmin
    by_hand = 2 * (2 / 3400 + 4.9 / 4700 - 6.9 / 5700) * 3437.75
    mine = next(r for r in finding.rows if (r.row.size, r.row.ratio_class) == (14, "50"))
    assert mine.booked_arcmin == pytest.approx(by_hand, rel=1e-4)


def test_page_is_what_is_found(finding) -> None:
    assert PAGE.read_text(encoding="utf-8") == page(finding)


def test_bad_row_is_refused(tmp_path) -> None:
    text = (DATA / "hd_torsional_stiffness.csv").read_text(encoding="utf-8").splitlines()
    text[3] = text[3].replace("0.19", "soft")
    bad = tmp_path / "bad.csv"
    bad.write_text("\n".join(text), encoding="utf-8")
    with pytest.raises(MeasurementError) as caught:
        read_catalogue(bad)
    assert caught.value.line == 4
