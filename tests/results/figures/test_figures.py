"""Charts: size, ink, repeatability, and the uncertainty band."""

import numpy as np
import pytest
from hand_made_gear import BACKLASH, K_B, K_E
from PIL import Image

from flexspline.results.figures.backlash_budget import write_budget
from flexspline.results.figures.convergence import write_convergence
from flexspline.results.figures.torque_angle import band, drawn_branch, write_torque_angle


def line(torque):
    return 25.0 * torque + np.sign(torque) * 36.1


DRAWINGS = {
    "budget": lambda path: write_budget(path, BACKLASH),
    "torque_angle": lambda path: write_torque_angle(path, drawn_branch(line, 0.5), 0.5, BACKLASH),
    "convergence": lambda path: write_convergence(
        path, {"K_b_Nm_per_rad": K_B, "K_e_Nm_per_rad": K_E}
    ),
}


@pytest.mark.parametrize("name", DRAWINGS)
def test_chart_is_drawn_whole_and_the_same_each_time(tmp_path, name):
    for copy in ("a.png", "b.png"):
        DRAWINGS[name](tmp_path / copy)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    with Image.open(tmp_path / "a.png") as image:
        data = np.asarray(image.convert("RGB"))
    assert data.shape[1] == 1600
    assert 0.02 < (data < 250).any(axis=2).mean() < 0.7
    for edge in (data[0], data[-1], data[:, 0], data[:, -1]):
        assert (edge == 255).all()  # nothing is cut off at the edge


def test_band_at_the_load_is_half_the_total_s_deviation():
    assert 2 * band(np.array([0.5]), 0.5, BACKLASH)[0] == pytest.approx(
        BACKLASH.std_arcsec, rel=1e-3
    )  # the fixture's figures have four digits


def test_band_without_torque_is_the_gap_s_alone():
    gap = np.hypot(10.98, 6.81) / 2
    assert band(np.array([0.0]), 0.5, BACKLASH)[0] == pytest.approx(gap)
