"""How the sum moves with a clearance: its own difference, by both models of the bearing play."""

import pytest
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.backlash import backlash
from flexspline.pipeline.study.clearance_slopes import clearance_slopes
from flexspline.results.study.sensitivity import lines, record

STEP_um = 1e-3
K = (31300.0, 43200.0)


@pytest.mark.parametrize("model", ["involute", "small_displacement"])
def test_each_slope_is_the_sum_s_difference(model: str) -> None:
    design = load_design(EXAMPLES / "xb1-40.toml").changed({"bearing.bearing_play_model": model})
    for slope in clearance_slopes(design):
        ends = (
            backlash(design.changed({slope.key: slope.value_um + side * STEP_um}), *K).total_arcsec
            for side in (1, -1)
        )
        high, low = ends
        assert slope.arcsec_per_um == pytest.approx((high - low) / (2 * STEP_um), rel=1e-6)


def test_both_are_told_with_the_dimensions() -> None:
    design = load_design(EXAMPLES / "xb1-40.toml")
    said = record(design, ())["clearances"]
    assert [c["key"] for c in said] == ["gear.flank_clearance_um", "bearing.radial_clearance_um"]
    table = lines(design, ())
    for c in said:
        assert any(c["key"] in line and f"{c['backlash_arcsec']:.1f}" in line for line in table)
