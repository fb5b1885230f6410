"""A report's summary and its last figure hold all that was found, sure causes and nameless structure too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.record import Specimens, Sweep
from flexspline.pipeline.diagnosis.outcome import DiagnosisOutcome, NamedCause, Unexplained
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import ChannelTest
from flexspline.results.diagnosis.summary import summary
from flexspline.results.figures.diagnosis.draw import draw_figures, residual_words

DESIGN = load_design(EXAMPLES / "xb1-40.toml")
NONE = np.zeros(0)
KINDS = {
    "sweep": Sweep(
        Path("m.csv"), History(NONE, NONE.astype(int), NONE.astype(int)), NONE, (), (), NONE, True
    ),
    "specimens": Specimens(Path("m.csv"), (), (), NONE, None, {}, NONE),
}
WEAR = NamedCause("wear", 0.6, ("thermal_clearance",), 1.2, 0.04, "arcsec/cycle", 40.0, 2.0)
FRICTION = NamedCause("friction_hysteresis", 1.0, (), 22.7, 0.9, "arcsec", 300.0, 8.0)


@pytest.mark.parametrize("kind", KINDS)
def test_an_ambiguous_summary_says_the_sure_causes_too(kind: str) -> None:
    prediction = Prediction(10.0, 0.2, 60.0, 5.0)
    both = DiagnosisOutcome("ambiguous", (FRICTION, WEAR))
    said = summary(Diagnosis(DESIGN, KINDS[kind], prediction, both))
    assert (
        "do not show which: wear (gap that grows from cycle to cycle) cannot be distinguished from"
        in said
    )
    assert said.endswith(
        " Also identified: friction hysteresis, 22.70 ± 0.90 arcsec wide at T = 0 (beyond doubt)."
    )
    alone = DiagnosisOutcome("ambiguous", (WEAR,))
    assert "Beside it" not in summary(Diagnosis(DESIGN, KINDS[kind], prediction, alone))


def left_over(channel: str, p_value: float) -> ChannelTest:
    return ChannelTest(channel, 0.8, p_value)


def test_a_panel_says_what_the_model_holds_without_a_name() -> None:
    tests = [left_over("torque_Nm", 0.5), left_over("time_s", 0.5), left_over("cycle", 1e-9)]
    wave = Unexplained("time_s", 1.3, 1e-6, (UnnamedForm("wave"),))
    assert residual_words(tests, [wave]) == {
        "torque_Nm": "no further structure",
        "time_s": "fitted, no cause known, 1.3 arcsec",
        "cycle": "structure left, 0.80 arcsec",
    }
    assert residual_words(tests, [])["torque_Nm"] == "no structure left"


def test_the_residual_s_caption_says_where_something_nameless_remains(tmp_path: Path) -> None:
    """Friction, and a wave in time of a fifth of it: named beside something without a name."""
    i = np.arange(720)
    rng = np.random.default_rng(2)
    torque = 10 * (1 - 4 * np.abs(((i + 0.5) / 120 + 0.25) % 1 - 0.5))
    loop = 12.0 * np.sign(np.gradient(torque)) * (1 - (torque / 10) ** 2)
    angle = 11.343 * torque + 36.1 * np.sign(torque) - loop + rng.normal(0, 0.4, len(i))
    angle += 2.0 * np.sin(2 * np.pi * i / 53)
    body = "".join(f"{3 * k},{t:.4f},{a:.3f}\n" for k, t, a in zip(i, torque, angle, strict=True))
    path = tmp_path / "rig.csv"
    path.write_text("time_s,torque_Nm,angle_arcsec\n" + body)
    found = diagnose_file(DESIGN, path, 31329.0, 43339.0)
    assert found.verdict == "named"
    assert found.outcome.unexplained
    (last,) = (f for f in draw_figures(found, tmp_path) if f.path.stem == "residual_model")
    assert "explains lies in: time" in last.caption
