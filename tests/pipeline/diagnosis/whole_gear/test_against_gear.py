"""A sweep held against the whole gear's curve: what bends as the gear does is no finding."""

from __future__ import annotations

from pathlib import Path

import in_process
import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

import flexspline
from flexspline.pipeline.analysis import analysis_context
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.bend import Bend
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError, ModelFileError
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.model.extended_backlash import extended_backlash
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.model.model_file import Provenance, read_model_file
from flexspline.pipeline.diagnosis.model.model_text import model_text
from flexspline.pipeline.diagnosis.prediction import prediction_of
from flexspline.pipeline.diagnosis.whole_gear.against import against_gear
from flexspline.pipeline.diagnosis.whole_gear.central_curve import CentralCurve
from flexspline.pipeline.diagnosis.whole_gear.fitted_input import angles_as_recorded
from flexspline.pipeline.gear.gear_chain import Chain, chain_of

DESIGN = flexspline.load_design(EXAMPLES / "xb1-40.toml").changed({"shaft.bolt_count": 0})
LARGEST_Nm, FRICTION_arcsec = 10.0, 6.0
K_b, K_e = 31_300.0, 44_000.0


@pytest.fixture(scope="module")
def chain() -> Chain:
    return chain_of(analysis_context(DESIGN))


@pytest.fixture(scope="module")
def record(chain: Chain, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Four cycles of the gear's own curve, a friction of ± 6 arcsec on it, and noise."""
    share = np.concatenate([np.linspace(0, 1, 60), np.linspace(1, -1, 120), np.linspace(-1, 0, 60)])
    torque = LARGEST_Nm * np.tile(share, 4)
    grid = LARGEST_Nm * np.linspace(0.001, 1, 60)
    curve = chain.angles(grid.tolist()) * ARCSEC_PER_RAD
    angle = np.sign(torque) * np.interp(np.abs(torque), grid, curve)
    angle -= FRICTION_arcsec * np.sign(np.gradient(torque))
    angle += np.random.default_rng(5).normal(0, 0.4, len(torque))
    path = tmp_path_factory.mktemp("gear") / "sweep.csv"
    rows = zip(torque, angle, strict=True)
    text = "".join(f"{i // 240 + 1},{i},{t:.4f},{a:.3f}\n" for i, (t, a) in enumerate(rows))
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text)
    return path


def test_the_prediction_is_the_gear_s_curve(chain: Chain) -> None:
    found = against_gear(prediction_of(DESIGN, K_b, K_e), chain, LARGEST_Nm)
    torque = np.array([0.3, 1.0, 3.0, 7.0, 10.0])
    expected = chain.angles(torque.tolist()) * ARCSEC_PER_RAD
    both = [found.angle_arcsec(History.course(sign * torque)) for sign in (1, -1)]
    # between the curve's places it is a chord: within two hundredths of the largest bend
    np.testing.assert_allclose(both[0], expected, atol=0.02 * max(found.bend.angle_arcsec))
    np.testing.assert_allclose(both[1], -both[0])


def test_what_bends_as_the_gear_does_is_no_hardening(chain: Chain, record: Path) -> None:
    straight = diagnose_file(DESIGN, record, K_b, K_e)
    assert "stiffness_hardening" in {c.id for c in straight.causes}
    found = diagnose_file(DESIGN, record, K_b, K_e, chain=chain)
    ids = {c.id for c in found.causes}
    assert not ids & {"stiffness_hardening", "series_compliance"}
    friction = {"friction_hysteresis", "rate_dependence"}  # one rate: the two cannot be told
    assert ids <= friction
    assert ids
    gain = found.outcome.gain
    assert gain is not None
    assert gain.rmse_before == pytest.approx(FRICTION_arcsec, rel=0.05)
    assert gain.rmse_after < 1.2 * gain.noise_floor


def test_a_place_that_was_read_at_no_torque_has_an_angle(chain: Chain) -> None:
    """Friction ahead of the teeth leaves them torque there: the row is used. It was a traceback."""
    read = (np.array([0.0, 0.4]), np.array([5.0]), np.array([10.0]))
    curve = CentralCurve(read, np.zeros(3), np.ones(3))
    found = angles_as_recorded(chain, curve, chain.model.at_torque(curve.smallest_Nm))
    near, *rest = chain.angles([0.4, 5.0, 10.0]) * ARCSEC_PER_RAD
    # chords of the curve's places: within two hundredths, as above
    np.testing.assert_allclose(found[1:], rest, rtol=0.02)
    assert 0 < found[0] < near


def test_a_bend_is_odd_and_goes_on_beyond_its_end() -> None:
    bend = Bend((0.0, 1.0, 2.0), (0.0, 3.0, 0.0))
    np.testing.assert_allclose(bend.at(np.array([-1.0, 0.0, 0.5, 1.0, 3.0])), [-3, 0, 1.5, 3, -3])


def test_a_model_file_keeps_the_bend(tmp_path: Path) -> None:
    model = ExtendedModel(11.0, 70.0, {"": 5.0}, {}, {}, Bend((0.0, 1.0, 2.0), (0.0, 3.0, 0.0)))
    origin = Provenance("flexspline", "a", "m.csv", "0" * 64, "named", K_b, K_e, True, {}, {})
    path = tmp_path / "model.toml"
    text = model_text(model, origin)
    path.write_text(text, encoding="utf-8")
    back = read_model_file(path).model
    assert back == model
    np.testing.assert_allclose(back.angle_arcsec([1.0, -1.0]), [5 + 11 + 35 + 3, 5 - 11 - 35 - 3])
    for old, new in (("[0.0, 1.0, 2.0]", "[0.0, 2.0, 1.0]"), ("[0.0, 3.0, 0.0]", "[0.0, 3.0]")):
        path.write_text(text.replace(old, new), encoding="utf-8")
        with pytest.raises(ModelFileError, match=r"\[bend\]"):
            read_model_file(path)


def test_the_budget_of_an_extended_model_has_the_bend_in_it() -> None:
    """What the sum becomes with the model is what the model itself predicts between the two torques."""
    model = ExtendedModel(11.0, 70.0, {"": 5.0}, {}, {}, Bend((0.0, 1.0, 2.0), (0.0, 3.0, 0.0)))
    nominal = flexspline.backlash(DESIGN, K_b, K_e)
    high, low = model.angle_arcsec([1.0, -1.0])
    assert extended_backlash(nominal, model, 1.0).total_arcsec == pytest.approx(high - low)


def test_only_a_sweep_is_held_against_the_gear(chain: Chain) -> None:
    points = EXAMPLES / "measured" / "size-40-end-points.csv"
    with pytest.raises(MeasurementError, match="is not a torque sweep"):
        diagnose_file(DESIGN, points, K_b, K_e, chain=chain)


def test_a_stiffness_given_is_refused_beside_it(record: Path, tmp_path: Path) -> None:
    cup = EXAMPLES / "xb1-40.toml"
    words = ("diagnose", cup, record, "--against", "gear", "--Kb", 3e4)
    done = in_process.flexspline(*words, folder=tmp_path)
    assert done.status == 2
    assert done.stderr == (
        "flexspline: --against gear: leave out --Kb: the curve comes from the drawing\n"
    )  # the option, not the design file
    with pytest.raises(flexspline.FlexsplineError, match="takes no K_b"):
        flexspline.diagnose(DESIGN, record, K_b=K_b, against="gear")
