"""Which bounds are theorems, by solving: those of a body of revolution under torsion, or of two."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from example_files import EXAMPLES
from toothed import toothed

from flexspline.fea.toothed_ring.equivalent import EquivalentRing
from flexspline.geometry.design import Design
from flexspline.geometry.load import design_from
from flexspline.pipeline import parts
from flexspline.pipeline.analysis import stiffnesses
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.stiffnesses import Stiffnesses
from flexspline.results.records import stiffness_record

LOOSE_PCT = 5.0
"""Kinds are asked, not figures: the coarsest meshes do."""


def design(file: str, model: str = "auto", **changes: object) -> Design:
    """An example; ``flexspline__bolt_count=0`` sets a key, None takes it away."""
    data = tomllib.loads((EXAMPLES / file).read_text(encoding="utf-8"))
    for dotted, value in changes.items():
        table, key = dotted.split("__")
        data[table].pop(key, None)
        if value is not None:
            data[table][key] = value
    data["solver"] = {"model": model, "tolerance_pct": LOOSE_PCT}
    return design_from(data)


def kinds(asked: Design, folder: Path, *, rim: bool, shaft: bool = True) -> dict[str, str]:
    context = AnalysisContext(asked, Cache(folder), Progress())
    found: Stiffnesses = stiffnesses(context, shaft=shaft, rim=rim)
    assert not found.missing
    record = stiffness_record(asked, found, 0.0)
    named = {k.removesuffix("_bounds_kind"): v for k, v in record.items() if k.endswith("kind")}
    # every stiffness with bounds says what they are
    assert {f"{name}_bounds_Nm_per_rad" for name in named} == {
        k for k in record if "_bounds_Nm" in k
    }
    return named


def test_of_a_body_of_revolution_torsion_alone_is_guaranteed(tmp_path: Path) -> None:
    plain = design("keyed-shaft.toml", shaft__keyway=None, shaft__bolt_count=0)
    assert kinds(plain, tmp_path, rim=True) == {
        "K_b": "guaranteed", "K_e": "guaranteed", "K_b_lobes": "estimated",
        "K_b_lobes_contact": "estimated", "K_b_lobes_unsupported": "estimated",
    }  # fmt: skip


@pytest.mark.parametrize("file", ["xb1-40.toml", "hat-25.toml"])
def test_with_bolt_holes_two_bodies_guarantee_torsion(file: str, tmp_path: Path) -> None:
    assert kinds(design(file), tmp_path, rim=False, shaft=False) == {"K_b": "guaranteed"}


@pytest.mark.parametrize(
    ("asked", "beside"),
    [
        # two bodies of revolution are solved to check it, so what they prove is told too
        pytest.param(design("xb1-40.toml", "solid"), ["K_b_guaranteed"], id="holed cup"),
        pytest.param(design("xb1-40.toml", "solid", flexspline__bolt_count=0), [], id="plain cup"),
    ],
)
def test_nothing_of_the_solid_model_alone_is_guaranteed(
    asked: Design, beside: list[str], tmp_path: Path
) -> None:
    proven = dict.fromkeys(beside, "guaranteed")
    assert kinds(asked, tmp_path, rim=False, shaft=False) == {"K_b": "estimated"} | proven


def test_drawn_teeth_with_bolt_holes_are_an_estimate_too(tmp_path: Path, monkeypatch) -> None:
    ring = EquivalentRing(0.55, 0.6, 0.58, 0.57, 1e-5, 100)
    monkeypatch.setattr(parts, "ring_of", lambda *given: ring)
    asked = toothed("trapezoid", {"shaft.bolt_count": 0})
    assert asked.flexspline.bolt_count
    assert kinds(asked, tmp_path, rim=False, shaft=False) == {"K_b": "estimated"}


@pytest.mark.cad
def test_a_keyway_makes_k_e_an_estimate(tmp_path: Path) -> None:
    asked = design("keyed-shaft.toml").changed({"solver.tolerance_pct": 5.0})
    assert kinds(asked, tmp_path, rim=False) == {"K_b": "guaranteed", "K_e": "estimated"}


def test_drawn_teeth_make_k_b_an_estimate(tmp_path: Path, monkeypatch) -> None:
    """The bounds are of the part with a plain ring; that it is as stiff as the teeth is no theorem."""
    ring = EquivalentRing(0.55, 0.6, 0.58, 0.57, 1e-5, 100)
    monkeypatch.setattr(parts, "ring_of", lambda *given: ring)
    asked = toothed("trapezoid", {"flexspline.bolt_count": 0, "shaft.bolt_count": 0})
    assert kinds(asked, tmp_path, rim=False) == {"K_b": "estimated", "K_e": "guaranteed"}
