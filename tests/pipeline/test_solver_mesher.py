"""`solver.mesher`: which mesher a solid model is made by, and that both answer the same."""

from __future__ import annotations

from pathlib import Path

import pytest
from example_files import EXAMPLES

from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import load_design
from flexspline.pipeline.analysis import stiffnesses
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.part_stiffness import part_stiffness
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress

PLAIN = {"flexspline.bolt_count": 0, "solver.model": "solid", "solver.tolerance_pct": 2.0}


def context_of(design: Design, folder: Path) -> tuple[AnalysisContext, list[str]]:
    said: list[str] = []
    return AnalysisContext(design, Cache(folder, said.append), Progress(said.append)), said


def with_mesher(mesher: str) -> Design:
    return load_design(EXAMPLES / "xb1-40.toml").changed({**PLAIN, "solver.mesher": mesher})


@pytest.mark.long  # of six holes and of a keyway by default: test_swept.py
@pytest.mark.cad
def test_a_plain_cup_has_one_stiffness_by_both_meshers(tmp_path: Path) -> None:
    """One cache for both: an answer by one mesher is none for the other."""
    swept, swept_said = context_of(with_mesher("swept"), tmp_path)
    tetwild, tetwild_said = context_of(with_mesher("tetwild"), tmp_path)
    a = part_stiffness(swept.part("flexspline"))
    b = part_stiffness(tetwild.part("flexspline"))
    # fTetWild needs the CAD solid's surface, a sweep the meridian alone
    assert not any("CAD" in line for line in swept_said)
    assert any("CAD" in line for line in tetwild_said)
    # K lies within the bounds of both
    assert a.lower_Nm_per_rad <= b.upper_Nm_per_rad
    assert b.lower_Nm_per_rad <= a.upper_Nm_per_rad
    assert a.K_Nm_per_rad == pytest.approx(b.K_Nm_per_rad, rel=a.half_width + b.half_width)


def test_auto_sweeps_what_can_be_swept(tmp_path: Path) -> None:
    auto, said = context_of(with_mesher("auto"), tmp_path / "a")
    swept, _ = context_of(with_mesher("swept"), tmp_path / "b")
    of_auto = part_stiffness(auto.part("flexspline"))
    of_swept = part_stiffness(swept.part("flexspline"))
    assert of_auto.K_Nm_per_rad == pytest.approx(of_swept.K_Nm_per_rad, rel=1e-9)
    assert not any("CAD" in line for line in said)


@pytest.mark.parametrize("wanted", ["swept", "auto", "tetwild"])
def test_holes_beside_a_narrow_land_cannot_be_swept(wanted: str, tmp_path: Path) -> None:
    """Of the example cup, 0.005 mm from its boss's edge."""
    cup = load_design(EXAMPLES / "xb1-40.toml").changed(
        {"solver.mesher": wanted, "flexspline.bolt_circle_diameter_mm": 15.49}
    )
    context, _ = context_of(cup, tmp_path)
    if wanted != "swept":
        assert not context.part("flexspline").is_swept
        return
    with pytest.raises(DesignError, match=r"solver.mesher.*holes.*\"tetwild\" or \"auto\" works"):
        stiffnesses(context, shaft=False)
    assert not (tmp_path / "mesh").exists()  # before the long work


def test_another_word_is_refused() -> None:
    with pytest.raises(DesignError, match=r"solver.mesher.*auto.*swept.*tetwild"):
        with_mesher("netgen")
