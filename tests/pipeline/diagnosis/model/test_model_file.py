"""extended_model.toml: an exact round trip, and every fault refused with one line."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from histories import PREDICTION, shape_of, sweep

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Element, FitContext
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError, ModelFileError
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.model.model_file import ModelFile, Provenance, read_model_file
from flexspline.pipeline.diagnosis.model.model_text import model_text
from flexspline.pipeline.diagnosis.model.predict import predict_file
from flexspline.results.diagnosis.prediction_words import prediction_warnings

FRICTION = shape_of("friction_hysteresis", threshold_Nm=0.3, spread=2, loaded=0, held=1, start=0)
AHEAD = {"stiffness_ratio": 12.3, "deadband_Nm": 0.003}
ORIGIN = Provenance(
    "flexspline 0.1.0",
    'a "gear"',
    "m.csv",
    "0" * 64,
    "named",
    31329.0,
    43339.0,
    True,
    {"a": 1.0, "b": 3.0},
    {"a": 0.5},
)
MODEL = ExtendedModel(
    1 / 0.0873,
    70.1 / 3,
    {"a": 0.1 + 0.2, "b": -1e-17},
    {
        "friction_hysteresis": (Element(AHEAD, (0.21,)), Element(FRICTION, (2.4630052653391297,))),
        "thermal_clearance": (Element(shape_of("thermal_clearance"), (-0.4237122462383699,)),),
        "kinematic_error": (Element(shape_of("kinematic_error"), (1 / 3, -2 / 7)),),
        "torque_offset": (Element({}, (0.01,)),),
    },
    {"a": (0.01, -0.3), "b": (-0.01, 0.3)},
)  # fmt: skip
LONELY = ExtendedModel(11.0, 70.0, {"": 5.0}, {}, {})


def written(folder: Path, model: ExtendedModel = MODEL, origin: Provenance = ORIGIN) -> Path:
    path = folder / "model.toml"
    path.write_text(model_text(model, origin), encoding="utf-8")
    return path


def test_round_trip_is_exact(tmp_path: Path) -> None:
    back = read_model_file(written(tmp_path))
    assert back == ModelFile(tmp_path / "model.toml", MODEL, ORIGIN)
    history = sweep(units=2)
    angles = [m.angle_of(history, ("a", "b")) for m in (MODEL, back.model)]
    assert np.abs(angles[0] - angles[1]).max() <= 1e-9  # arcsec, as asked; the doubles are the same


def test_every_cause_s_every_shape_makes_the_round_trip(tmp_path: Path) -> None:
    rig = FitContext(PREDICTION, sweep())
    elements = {}
    for cause in known_causes().values():
        shapes = cause.shapes(rig) or [{}]
        widths = [cause.columns(s, rig.history).shape[1] for s in shapes]
        elements[cause.id] = tuple(
            Element(s, (0.1,) * k) for s, k in zip(shapes, widths, strict=True)
        )
    model = replace(LONELY, elements=elements)
    assert read_model_file(written(tmp_path, model)).model == model


@pytest.mark.parametrize(
    "name", ['"', "\\", "ü–λ", "a\x7fb", "tab\t", "[[unit]]", "#no", "'''", "${x}"]
)
def test_names_are_data(name: str, tmp_path: Path) -> None:
    model = replace(LONELY, zeros_arcsec={name: 1.5})
    origin = replace(ORIGIN, design=name, first_cycle={name: 0.0}, first_time_s={})
    back = read_model_file(written(tmp_path, model, origin))
    assert back.model == model
    assert back.provenance == origin


GOOD = model_text(MODEL, ORIGIN)
GAP = "gap_arcsec = 23.366666666666664"
ONE = "amplitudes = [2.4630052653391297]"
FAULTS = {
    "no TOML": ("format = 1", "format = = 1", "not valid TOML"),
    "another format": ("format = 1", "format = 2", "format = 2: this program reads format 1"),
    "a format of text": ("format = 1", 'format = "1"', "must be a whole number"),
    "an unknown key": ("format = 1", "format = 1\ncolour = 3", "colour is not a key of the model"),
    "a missing key": ("gap_arcsec = 23", "# gap_arcsec = 23", "gap_arcsec is missing in [calibrated]"),
    "a gap of text": (GAP, 'gap_arcsec = "23"', "[calibrated] must be a number"),
    "a gap that is true": (GAP, "gap_arcsec = true", "must be a number"),
    "an infinite gap": (GAP, "gap_arcsec = inf", "must be a number within"),
    "no stiffness at all": ("compliance_arcsec_per_Nm = 11", "compliance_arcsec_per_Nm = -11", "above 0"),
    "an unknown cause": ('id = "friction_hysteresis"', 'id = "gremlins"', '"gremlins" is not a known cause'),
    "a cause twice": ('id = "thermal_clearance"', 'id = "friction_hysteresis"', "appears twice"),
    "a unit twice": ('name = "b"', 'name = "a"', "appears twice"),
    "an unknown parameter": ("threshold_Nm", "threshold_lbf", "it takes"),
    "an unknown law": ("spread = 2", "spread = 9", "has spread = 9; it takes 0, 1, 2, 3"),
    "a parameter of text": ("threshold_Nm = 0.3", 'threshold_Nm = "0.3"', "must be a number within"),
    "a huge parameter": ("threshold_Nm = 0.3", "threshold_Nm = 1" + "0" * 400, "must be a number within"),
    "a gap beyond doubles": (GAP, "gap_arcsec = 1" + "0" * 400, "must be a number within"),
    "a gap beyond any gear": (GAP, "gap_arcsec = 1e308", "must be a number within"),
    "a parameter that is not": ("threshold_Nm = 0.3", "threshold_Nm = nan", "must be a number within"),
    "a slider without friction": ("threshold_Nm = 0.3", "threshold_Nm = 0.0", "a shape of friction"),
    "a negative friction": ("amplitudes = [2.46", "amplitudes = [-2.46", "negative, which physics forbids"),
    "no amplitude": (ONE, "amplitudes = []", "must be numbers within"),
    "an amplitude too many": (ONE, "amplitudes = [2.4, 1.0]", "has 2 amplitudes; it takes 1"),
    "an amplitude of text": (ONE, 'amplitudes = ["2"]', "must be numbers within"),
    "time that is a number": ("time_recorded = true", "time_recorded = 1", "must be true or false"),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_faults_are_named(name: str, tmp_path: Path) -> None:
    old, new, needle = FAULTS[name]
    assert old in GOOD
    path = tmp_path / "model.toml"
    path.write_text(GOOD.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ModelFileError) as caught:
        read_model_file(path)
    assert needle in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1
    assert "model.toml" in str(caught.value)


@pytest.mark.parametrize(
    ("data", "needle"),
    [
        (b"\xff\xfe", "not UTF-8"),
        (b"", "the file is empty"),
        (b"name = 'XB1-40 cup'", "not an extended model"),
        (b"#" * 1_000_001, "at most"),
        (b"a = " + b"[" * 5000, "nested too deeply"),
    ],
)
def test_other_files_are_refused(data: bytes, needle: str, tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_bytes(data)
    with pytest.raises(ModelFileError, match=needle):
        read_model_file(path)
    with pytest.raises(ModelFileError, match="no such file"):
        read_model_file(tmp_path / "none.toml")


# ---- predictions


def test_angles_by_hand(tmp_path: Path) -> None:
    """5 + 11 T ± 35, no cause."""
    file = read_model_file(written(tmp_path, LONELY, replace(ORIGIN, first_cycle={"": 0.0})))
    csv = tmp_path / "t.csv"
    csv.write_text("torque_Nmm\n1000\n-500\n0\n")
    predicted = predict_file(file, csv)
    np.testing.assert_allclose(predicted.angle_arcsec, [51.0, -35.5, 5.0], atol=1e-12)
    assert predicted.new_units == predicted.beyond == ()


def test_a_missing_channel_is_named(tmp_path: Path) -> None:
    file = read_model_file(written(tmp_path))
    csv = tmp_path / "t.csv"
    csv.write_text("torque_Nm,input_angle_deg,unit\n1,0,a\n")
    with pytest.raises(MeasurementError, match="temperature_C is missing; thermal_clearance in"):
        predict_file(file, csv)
    csv.write_text("angle_arcsec\n1\n")
    with pytest.raises(MeasurementError, match="torque_Nm is missing"):
        predict_file(file, csv)


def test_a_torque_that_no_gear_carries_is_refused(tmp_path: Path) -> None:
    """Also by a model that does not say over which torques it was measured."""
    file = read_model_file(written(tmp_path, LONELY))
    csv = tmp_path / "t.csv"
    csv.write_text("torque_Nm\n1\n2e9\n")
    with pytest.raises(MeasurementError, match=r"torque_Nm = 2e\+09 is beyond") as no:
        predict_file(file, csv)
    assert no.value.line == 3


def test_cycles_go_on_from_the_record_s_first(tmp_path: Path) -> None:
    """Wear of 6 arcsec from cycle 3 to 5 of the file: half of it on either side of the gap."""
    shape = shape_of("wear", sweep(cycles=3), exponent=1.0, run_in_cycles=0.0, steady=0)
    model = replace(LONELY, elements={"wear": (Element(shape, (6.0,)),)})
    file = read_model_file(written(tmp_path, model, replace(ORIGIN, first_cycle={"": 3.0})))
    csv = tmp_path / "t.csv"
    csv.write_text("torque_Nm,cycle\n1,4\n1,5\n-1,5\n")
    np.testing.assert_allclose(
        predict_file(file, csv).angle_arcsec, [51 + 1.5, 51 + 3, -41 - 3], atol=1e-12
    )
    csv.write_text("torque_Nm,cycle\n1,2\n")
    with pytest.raises(MeasurementError, match="cycle = 2 lies before the model's first, 3"):
        predict_file(file, csv)


def test_a_record_without_time_counts_rows(tmp_path: Path) -> None:
    shape = shape_of("sensor_drift", exponent=1.0, settling_s=0.0, duration_s=4.0)
    model = replace(LONELY, elements={"sensor_drift": (Element(shape, (8.0,)),)})
    csv = tmp_path / "t.csv"
    csv.write_text("torque_Nm\n1\n1\n1\n")
    timed = read_model_file(written(tmp_path, model, replace(ORIGIN, first_cycle={"": 0.0})))
    with pytest.raises(MeasurementError, match="time_s is missing"):
        predict_file(timed, csv)
    origin = replace(ORIGIN, first_cycle={"": 0.0}, time_recorded=False)
    rows = read_model_file(written(tmp_path, model, origin))
    np.testing.assert_allclose(predict_file(rows, csv).angle_arcsec, [51, 53, 55], atol=1e-12)


def test_drift_goes_on_where_the_record_began(tmp_path: Path) -> None:
    """8 arcsec in 4 s, from 100 s on: a file that starts at 102 s has half of it behind it."""
    shape = shape_of("sensor_drift", exponent=1.0, settling_s=0.0, duration_s=4.0)
    model = replace(LONELY, elements={"sensor_drift": (Element(shape, (8.0,)),)})
    origin = replace(ORIGIN, first_cycle={}, first_time_s={"": 100.0})
    file = read_model_file(written(tmp_path, model, origin))
    csv = tmp_path / "t.csv"
    for first, before in ((100, 0.0), (102, 4.0), (0, 0.0)):  # the last is another clock
        csv.write_text(f"torque_Nm,time_s\n1,{first}\n1,{first + 1}\n")
        expected = [51 + before, 53 + before]
        np.testing.assert_allclose(predict_file(file, csv).angle_arcsec, expected, atol=1e-12)


def test_a_strange_unit_is_told(tmp_path: Path) -> None:
    file = read_model_file(written(tmp_path))
    csv = tmp_path / "t.csv"
    csv.write_text("torque_Nm,temperature_C,input_angle_deg,unit\n1,20,0,c\n")
    predicted = predict_file(file, csv)
    assert predicted.new_units == ("c",)
    (warning,) = prediction_warnings(predicted)
    assert "unit c: not in the model" in warning
