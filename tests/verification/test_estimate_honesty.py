"""Honesty of the solid model's error estimate (Zienkiewicz and Zhu 1987, scaled by two meshes).

True error over estimated error on eleven designs; K itself from two-sided bounds (Michell 1899).
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
import pytest
from hole_free import CASES, DEFAULT, REFERENCE, SOLUTIONS, TOLERANCE, solved

from flexspline.geometry.percent import percent


def ratio(name: str, kind: str = "chosen", tolerance: float = TOLERANCE) -> float:
    pair = solved(name, kind, tolerance)
    return pair.true_error / pair.estimated_error


@pytest.mark.parametrize(("name", "kind", "tolerance"), SOLUTIONS)
def test_true_error_over_estimate(name: str, kind: str, tolerance: float, record) -> None:
    """The demand: between 0.3 and 3 on the finest mesh, the one that is reported."""
    pair, found = solved(name, kind, tolerance), ratio(name, kind, tolerance)
    how = {"chosen": "", "fTetWild": " (fTetWild)"}[kind]
    what = f"True over estimated error, {name}, to {percent(tolerance)}{how}"
    record(what, "demanded", (0.3, 3.0), found, digits=2)
    # the bounds' half width is what the true error is uncertain by: small beside the estimate
    assert REFERENCE / 2 * pair.exact.K_Nm_per_rad < 0.2 * pair.estimated_error
    assert 0.3 < found < 3.0


@pytest.mark.parametrize(
    ("cases", "least"),
    [(DEFAULT, 5), pytest.param(CASES, 10, marks=pytest.mark.long)],
    ids=["some", "all"],
)
def test_no_bias_over_many_designs(cases: Collection[str], least: int) -> None:
    """An estimate that is honest on the whole has a median near 1, not only extremes in range."""
    assert len(cases) >= least  # fewer would say little of the factor
    # one mesh takes the usual scale, two have their own, each with its scatter: 0.8 to 1.8 measured
    assert 0.6 < np.median([ratio(name) for name in cases]) < 1.6
