"""Against the gear's curve: a gear stiffer or softer all over is no hardening, and no spring in series is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

import flexspline
from flexspline.pipeline.analysis import analysis_context
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.gear_chain import Chain, chain_of
from flexspline.results.diagnosis.notes import notes

DESIGN = flexspline.load_design(EXAMPLES / "xb1-40.toml").changed({"shaft.bolt_count": 0})
LARGEST_Nm, HALF_GAP_arcsec, COMPLIANCE = 10.0, 29.32, 24.19
"""Half the free angle and the chord of that gear's curve, arcsec and arcsec per N·m."""
K_b, K_e = 31_300.0, 44_000.0


@pytest.fixture(scope="module")
def chain() -> Chain:
    return chain_of(analysis_context(DESIGN))


def measured(chain: Chain, times: float, spring: float, folder: Path) -> Diagnosis:
    """Four cycles of the gear's curve, its twist so many `times`, with a `spring` [arcsec per N·m] behind."""
    share = np.concatenate([np.linspace(0, 1, 60), np.linspace(1, -1, 120), np.linspace(-1, 0, 60)])
    torque = LARGEST_Nm * np.tile(share, 4)
    grid = LARGEST_Nm * np.linspace(0.001, 1, 60)
    curve = chain.angles(grid.tolist()) * ARCSEC_PER_RAD
    twist = np.interp(np.abs(torque), grid, curve) - HALF_GAP_arcsec
    angle = np.sign(torque) * (HALF_GAP_arcsec + times * twist) + spring * torque
    angle += np.random.default_rng(5).normal(0, 0.4, len(torque))
    path = folder / "sweep.csv"
    text = "".join(
        f"{i // 240 + 1},{i},{t:.4f},{a:.3f}\n"
        for i, (t, a) in enumerate(zip(torque, angle, strict=True))
    )
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text)
    return diagnose_file(DESIGN, path, K_b, K_e, chain=chain)


@pytest.fixture(scope="module")
def soft(chain: Chain, tmp_path_factory: pytest.TempPathFactory) -> Diagnosis:
    """Of a third of the twist."""
    return measured(chain, 1 / 3, 0.0, tmp_path_factory.mktemp("soft"))


@pytest.mark.parametrize(
    ("times", "spring"),
    [
        (1 / 3, 0.0),
        pytest.param(0.5, 0.0, marks=pytest.mark.long),
        pytest.param(1.6, 0.0, marks=pytest.mark.long),
        pytest.param(1.0, 5.0, marks=pytest.mark.long),
        (1.0, 20.0),
    ],
)
def test_a_gear_of_another_stiffness_is_that_and_nothing_else(
    times: float, spring: float, chain: Chain, soft: Diagnosis, tmp_path: Path
) -> None:
    found = soft if (times, spring) == (1 / 3, 0.0) else measured(chain, times, spring, tmp_path)
    assert found.verdict == "named"
    assert [c.id for c in found.causes] == ["series_compliance"]
    expected = 100 * (times - 1 + spring / COMPLIANCE)
    # half a percent: the curve is straight between its places
    assert found.causes[0].magnitude == pytest.approx(expected, abs=0.5)
    assert any("the same factor as its slope" in n for n in notes(found)) == (spring == 0)
    assert found.prediction.bend is not None
    assert found.model is not None
    simulated, kept = (max(bend.angle_arcsec) for bend in (found.prediction.bend, found.model.bend))
    assert kept == pytest.approx(times * simulated, rel=0.01)


def test_the_error_before_is_that_of_the_simulation(chain: Chain, soft: Diagnosis) -> None:
    """Nothing of the record's own bend goes into the simulation as it stands."""
    found = soft
    assert found.outcome.gain is not None
    grid = LARGEST_Nm * np.linspace(0.05, 0.98, 200)
    off = 2 / 3 * (chain.angles(grid.tolist()) * ARCSEC_PER_RAD - HALF_GAP_arcsec)
    assert found.outcome.gain.rmse_before == pytest.approx(np.sqrt((off**2).mean()), rel=0.02)
