"""A pair of teeth against the recorded pair of meshed teeth of benchmarks/tooth_pair_contact.py (NGSolve)."""

from __future__ import annotations

import json
from math import pi, radians
from pathlib import Path

import pytest

from flexspline.fea.gear.tooth_pair import flank_contact, tooth
from flexspline.fea.types import Elastic

RECORD = json.loads(
    (Path(__file__).parents[3] / "benchmarks" / "tooth_pair_contact.json").read_text("utf-8")
)
STEEL = Elastic(206e3, 0.3)
MODULE, LEVER = 0.3556, 0.4445  # mm: cup of size 14, ratio 50
MODEL = 2 * tooth(LEVER, pi * MODULE / 2, radians(20), MODULE, 1.0, STEEL) + flank_contact(
    1.0, STEEL, STEEL
)


def test_line_contact_on_a_deep_body() -> None:
    """What the model supposes. Compliance grows with the logarithm of the width over which the flanks touch,
    whatever the law: over crowns of 20 and 2 mm and four times the load by ± 12 % of the pair's."""
    deep = [
        row["compliance_mm2_N"]
        for row in RECORD["pairs"]
        if row["crown_mm"] is not None and row["behind_mm"] > 4 * LEVER
    ]
    assert deep
    assert deep == pytest.approx([MODEL] * len(deep), rel=0.15)


def test_no_other_flanks_or_ring_make_it_softer() -> None:
    """Flanks that touch all over, and a ring that cannot give way as a deep body does, are stiffer."""
    stiff = [
        row["compliance_mm2_N"]
        for row in RECORD["pairs"]
        if row["crown_mm"] is None or row["behind_mm"] < 2 * LEVER
    ]
    assert stiff
    assert all(0.35 * MODEL < compliance < MODEL for compliance in stiff)
