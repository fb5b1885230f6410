"""What a model's reader is told: whether it is of this design, and what its verdict left open."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from example_files import EXAMPLES
from histories import shape_of
from typer.testing import CliRunner

from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Element
from flexspline.pipeline.diagnosis.model.design_digest import design_digests
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.model.model_file import Provenance, read_model_file
from flexspline.pipeline.diagnosis.model.model_text import model_text
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.results.cli import app
from flexspline.results.diagnosis.model_notes import model_warnings

CUP = EXAMPLES / "xb1-40.toml"
DESIGN = load_design(CUP)
ORIGIN = Provenance(
    "flexspline", DESIGN.name, "m.csv", "0" * 64, "named", 31329.0, 43339.0, True, {}, {},
    design_digests(DESIGN),
)  # fmt: skip
MODEL = ExtendedModel(11.0, 70.0, {"": 0.0}, {"torque_offset": (Element({}, (0.01,)),)}, {})
SHIFT = NamedCause("torque_offset", 0.6, ("wear",), 0.01, 0.001, "N·m", 5.0, 1.0)


def said(folder: Path, origin: Provenance, design: Design = DESIGN) -> tuple[str, ...]:
    path = folder / "model.toml"
    path.write_text(model_text(MODEL, origin, (SHIFT,)), encoding="utf-8")
    return model_warnings(read_model_file(path), design)


def test_the_same_design_by_any_name_is_no_matter(tmp_path: Path) -> None:
    assert said(tmp_path, ORIGIN) == ()
    renamed = DESIGN.model_copy(update={"name": "XB1-40 cup, copy"})
    assert said(tmp_path, ORIGIN, renamed) == ()


@pytest.mark.parametrize(
    ("key", "value"),
    [("flexspline.wall_thickness_mm", 0.5), ("bearing.radial_clearance_um", 20.0),
     ("material.flexspline.youngs_modulus_GPa", 190.0)],
)  # fmt: skip
def test_other_values_under_the_same_name_are_told(key: str, value: float, tmp_path: Path) -> None:
    (line,) = said(tmp_path, ORIGIN, DESIGN.changed({key: value}))
    assert f"with other values in [{key.partition('.')[0]}]; " in line
    assert "K_b 31329 and K_e 43339 N·m/rad" in line


def test_a_file_without_digests_is_compared_by_name(tmp_path: Path) -> None:
    old = replace(ORIGIN, design_digests={})
    assert said(tmp_path, old) == ()
    (line,) = said(tmp_path, replace(old, design="another"))
    assert line.startswith(f"the model is for another, not for {DESIGN.name}; ")


def test_an_open_verdict_is_told_with_its_rivals(tmp_path: Path) -> None:
    (line,) = said(tmp_path, replace(ORIGIN, verdict="ambiguous"))
    shift, wear = (known_causes()[c].title_at(0.0) for c in ("torque_offset", "wear"))
    assert f"({shift} or {wear})" in line
    (line,) = said(tmp_path, replace(ORIGIN, verdict="unknown"))
    assert "no known cause explains" in line


def test_predict_prints_them(tmp_path: Path) -> None:
    said(tmp_path, replace(ORIGIN, verdict="ambiguous"))
    history = tmp_path / "torque.csv"
    history.write_text("time_s,torque_Nm\n0,0\n1,0.5\n2,-0.5\n", encoding="utf-8")
    words = ("predict", CUP, "--model", tmp_path / "model.toml", history, "--out", tmp_path)
    done = CliRunner().invoke(app, [str(w) for w in words])
    assert done.exit_code == 0, done.stderr
    assert "warning: the model's verdict is ambiguous" in done.stderr


def test_a_rate_without_time_is_told(tmp_path: Path) -> None:
    shape = shape_of(
        "rate_dependence", lag_s=2.0, exponent=1.0, rate_Nm_per_s=1.0, ramp_s=10.0, deadband_Nm=0.0
    )
    rate = replace(MODEL, elements={"rate_dependence": (Element(shape, (1.0,)),)})
    path = tmp_path / "model.toml"
    for timed in (True, False):
        text = model_text(rate, replace(ORIGIN, time_recorded=timed))
        path.write_text(text, encoding="utf-8")
        told = model_warnings(read_model_file(path), DESIGN)
        assert any("takes one row as one second" in line for line in told) == (not timed)
