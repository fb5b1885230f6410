"""Friction that never saturates may stand for a spring that the simulation lacks: the two are rivals."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis

pytestmark = pytest.mark.usefixtures("causes_only")

K_B, K_E = 31_300.0, 44_000.0


def diagnosed(torque_factor: float, tmp_path: Path) -> Diagnosis:
    """The example's sweep with its torque column times a factor: as of a gear so much softer."""
    text = (EXAMPLES / "measured" / "xb1-40-sweep.csv").read_text(encoding="utf-8")
    row = re.compile(r"^(\d+,[\d.]+,[\d.]+,)(-?[\d.]+)(,.*)$", re.M)
    path = tmp_path / "rig.csv"
    path.write_text(
        row.sub(lambda m: f"{m[1]}{float(m[2]) * torque_factor:.5f}{m[3]}", text), encoding="utf-8"
    )
    return diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, K_B, K_E)


def test_half_the_stiffness_beside_friction_is_a_spring_that_the_simulation_lacks(
    tmp_path: Path,
) -> None:
    found = diagnosed(0.5, tmp_path)
    causes = {c.id: c for c in found.outcome.causes}
    assert found.verdict == "ambiguous"
    # twice the compliance is 100 % more, whatever part of it the friction takes up
    spring = causes["series_compliance"]
    assert spring.magnitude == pytest.approx(100.0, abs=2 * spring.magnitude_std)
    assert spring.magnitude_std < 18.0
    assert spring.alternatives == ("stiffness_hardening",)
    assert "friction_hysteresis" in causes


@pytest.mark.parametrize("stiffness", [0.7, pytest.param(0.6, marks=pytest.mark.long)])
def test_friction_that_takes_the_spring_s_twist_has_it_for_a_rival(
    stiffness: float, tmp_path: Path
) -> None:
    found = diagnosed(stiffness, tmp_path)
    rivals = {c.id: c.alternatives for c in found.outcome.causes}
    assert found.verdict == "ambiguous"
    # all cycles run at one rate: a lag as long as a ramp looks the same, and another rate tells it at once
    assert rivals["friction_hysteresis"] == ("rate_dependence", "series_compliance")
    assert found.outcome.next_measurement is not None
    assert found.outcome.next_measurement.vary == "torque_rate"


def test_friction_of_a_gear_as_stiff_as_simulated_has_none(tmp_path: Path) -> None:
    found = diagnosed(1.0, tmp_path)
    assert {c.id: c.alternatives for c in found.outcome.causes}["friction_hysteresis"] == ()
