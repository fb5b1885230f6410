"""Which input of the gear's model explains a sweep: records of gears whose one input is another.

The records come from the same contact model, at other torques and with friction and noise. So they show
that the inputs can be told apart, not that a real gear obeys the model.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

import flexspline
from flexspline.pipeline.analysis import analysis_context
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.whole_gear import identification
from flexspline.pipeline.diagnosis.whole_gear.inputs import GearInput, inputs_of
from flexspline.pipeline.gear.gear_chain import Chain, chain_of
from flexspline.results.diagnosis.gear_inputs import gear_inputs_notes, gear_inputs_record

pytestmark = pytest.mark.usefixtures("causes_only")

DESIGN = flexspline.load_design(EXAMPLES / "xb1-40.toml").changed({
    "shaft.bolt_count": 0,
    "gear.module_mm": 0.4, "gear.teeth_flexspline": 100, "gear.teeth_circular_spline": 102,
})  # fmt: skip
"""As large as the example with half as many teeth, in less than half the time."""
LARGEST_Nm, FRICTION_arcsec = 10.0, 6.0
FLANK, PLAY, STROKE = (
    "gear.flank_clearance_um", "bearing.radial_clearance_um", "wave_generator.deflection_mm",
)  # fmt: skip
Twist = Callable[[np.ndarray], np.ndarray]


@pytest.fixture(scope="module")
def chain() -> Chain:
    return chain_of(analysis_context(DESIGN))


def diagnosed(
    chain: Chain, of: Chain, path: Path, noise: float = 0.4, more: Twist = np.zeros_like
) -> Diagnosis:
    """Of three cycles of another gear `of`, with friction, noise [arcsec] and one more twist."""
    share = np.concatenate([np.linspace(0, 1, 60), np.linspace(1, -1, 120), np.linspace(-1, 0, 60)])
    torque = LARGEST_Nm * np.tile(share, 3)
    grid = LARGEST_Nm * np.linspace(0.001, 1, 60)
    curve = of.angles(grid.tolist()) * ARCSEC_PER_RAD
    angle = np.sign(torque) * np.interp(np.abs(torque), grid, curve) + more(torque)
    angle -= FRICTION_arcsec * np.sign(np.gradient(torque))
    angle += np.random.default_rng(7).normal(0, noise, len(torque))
    rows = zip(torque, angle, strict=True)
    text = "".join(f"{i // 240 + 1},{i},{t:.4f},{a:.3f}\n" for i, (t, a) in enumerate(rows))
    path.write_text("cycle,time_s,torque_Nm,angle_arcsec\n" + text, encoding="utf-8")
    return diagnose_file(DESIGN, path, 31_300.0, 44_000.0, chain=chain)


def bends(torque: np.ndarray) -> np.ndarray:
    """Several arcsec that come and go with torque."""
    return 8 * np.sin(torque)


@pytest.fixture(scope="module")
def as_drawn(chain: Chain, tmp_path_factory: pytest.TempPathFactory) -> Diagnosis:
    return diagnosed(chain, chain, tmp_path_factory.mktemp("drawn") / "a.csv")


@pytest.fixture(scope="module")
def bent(chain: Chain, tmp_path_factory: pytest.TempPathFactory) -> Diagnosis:
    return diagnosed(chain, chain, tmp_path_factory.mktemp("bent") / "a.csv", more=bends)


@pytest.mark.parametrize(
    ("key", "factor"),
    [
        pytest.param(FLANK, 2.0, marks=pytest.mark.long),
        (PLAY, 1.6),
        pytest.param(STROKE, 1.025, marks=pytest.mark.long),
    ],
)
def test_the_changed_input_is_named_with_its_size(
    chain: Chain, tmp_path: Path, key: str, factor: float
) -> None:
    one = next(i for i in inputs_of(DESIGN, chain) if i.key == key)
    truth = factor * one.nominal
    found = diagnosed(chain, one.changed(chain, truth), tmp_path / "a.csv").gear_inputs
    assert found is not None
    assert found.outcome == "named"
    best = found.fitted[0]
    assert best.key == key
    # three deviations, of which the solver's 0.5 % is a part
    assert best.value == pytest.approx(truth, abs=3 * best.std)
    assert found.left_arcsec < 0.1 * found.before_arcsec
    record = gear_inputs_record(found)
    assert record["named"] == key
    assert key in gear_inputs_notes(found)[0]


def test_the_gear_as_drawn_leaves_nothing_to_explain(as_drawn: Diagnosis) -> None:
    found = as_drawn.gear_inputs
    assert found is not None
    assert found.outcome == "consistent"
    assert "named" not in gear_inputs_record(found)
    (said,) = gear_inputs_notes(found)
    assert said.endswith("not more than the scatter of the readings")


def test_an_input_that_moves_nothing_has_no_value(
    chain: Chain, as_drawn: Diagnosis, bent: Diagnosis, monkeypatch: pytest.MonkeyPatch
) -> None:
    idle = GearInput("idle", "mm", 1.0, 0.0, 2.0, 0.1, lambda chain, value: chain)
    monkeypatch.setattr(identification, "inputs_of", lambda design, chain: (idle,))
    assert as_drawn.sweep is not None
    found = identification.gear_inputs(DESIGN, chain, as_drawn.sweep)
    assert found is not None
    assert (found.outcome, found.fitted) == ("consistent", ())
    assert "not more than the scatter of the readings" in gear_inputs_notes(found)[0]
    assert bent.sweep is not None
    found = identification.gear_inputs(DESIGN, chain, bent.sweep)
    assert found is not None
    assert found.outcome == "unknown"
    assert json.dumps(gear_inputs_record(found), allow_nan=False)
    (said,) = gear_inputs_notes(found)
    assert "nearest" not in said


def test_a_twist_of_another_kind_is_not_named(bent: Diagnosis) -> None:
    """No clearance and no spring does that."""
    found = bent.gear_inputs
    assert found is not None
    assert found.outcome == "unknown"
    (said,) = gear_inputs_notes(found)
    assert "no single input and no pair of inputs" in said
    off = (found.fitted[0].chi_square / (found.places - 1)) ** 0.5  # of a chi square: 1 in the mean
    assert f"deviates from the readings by {off:.2g} standard deviations" in said
    assert off > 1.5


def test_what_noise_hides_has_rivals(chain: Chain, tmp_path: Path) -> None:
    """Two micrometres of play in ten arcsec of noise: what is named is not named alone."""
    one = next(i for i in inputs_of(DESIGN, chain) if i.key == PLAY)
    found = diagnosed(chain, one.changed(chain, one.nominal + 2), tmp_path / "a.csv", noise=10.0)
    inputs = found.gear_inputs
    assert inputs is not None
    # the play moves the curve by three deviations at each of 12 places: not as drawn
    assert inputs.chi_square > 9 * inputs.places
    assert inputs.outcome == "named"
    # in a noise of 0.4 arcsec the same gear's stroke fits worse by 44; ten arcsec leave less than 6 of that
    assert {inputs.fitted[0].key, *inputs.rivals} >= {PLAY, STROKE}


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ((FLANK, 3.0), (PLAY, 0.5)),
        pytest.param((PLAY, 1.6), ("compliance in series", 4e-6), marks=pytest.mark.long),
    ],
)
def test_two_inputs_that_both_changed_are_named_together(
    chain: Chain, tmp_path: Path, one: tuple[str, float], other: tuple[str, float]
) -> None:
    """A factor of the nominal value, or the value itself where that is 0."""
    inputs = {each.key: each for each in inputs_of(DESIGN, chain)}
    truth = {key: size * (inputs[key].nominal or 1.0) for key, size in (one, other)}
    gear = chain
    for key, value in truth.items():
        gear = inputs[key].changed(gear, value)
    found = diagnosed(chain, gear, tmp_path / "a.csv").gear_inputs
    assert found is not None
    assert found.outcome == "pair"
    agree = [pair for pair in found.pairs if set(pair.keys) == set(truth)]
    assert agree, [pair.keys for pair in found.pairs]
    for key, value, std in zip(agree[0].keys, agree[0].values, agree[0].stds, strict=True):
        assert value == pytest.approx(truth[key], abs=3 * std)
    assert found.left_arcsec < 0.2 * found.before_arcsec
    record = gear_inputs_record(found)
    assert "named" not in record
    assert {each["key"] for each in record["pairs"][0]["inputs"]} == set(found.pairs[0].keys)
    assert "two inputs together" in gear_inputs_notes(found)[0]


def test_no_input_is_negative(chain: Chain) -> None:
    """No length, no tooth's and no added spring's compliance is below 0."""
    assert all(one.low >= 0 for one in inputs_of(DESIGN, chain))


def test_a_gear_stiffer_than_simulated_has_no_negative_spring(chain: Chain, tmp_path: Path) -> None:
    """Three per cent of the shaft's compliance are missing: only other inputs may explain that."""
    series = next(i for i in inputs_of(DESIGN, chain) if i.key == "compliance in series")
    found = diagnosed(
        chain, series.changed(chain, -0.03 * chain.shaft), tmp_path / "a.csv"
    ).gear_inputs
    assert found is not None
    said = " ".join(gear_inputs_notes(found))
    assert "compliance in series = -" not in said
    assert "compliance in series = 0" not in said


def test_another_gap_is_the_model_built_anew(chain: Chain) -> None:
    """What the bodies yield is kept: the angle at a torque is that of the changed drawing."""
    inputs = {each.key: each for each in inputs_of(DESIGN, chain)}
    for key, value in ((FLANK, 7.0), (PLAY, 4.0), (STROKE, 0.408)):
        drawn = chain_of(analysis_context(DESIGN.changed({key: value})), 1 / chain.shaft)
        kept = inputs[key].changed(chain, value)
        assert kept.angles([1.0, 8.0]) == pytest.approx(drawn.angles([1.0, 8.0]), rel=1e-6)
