"""Mean lines of a panel: over all of a branch, however its values lie."""

from __future__ import annotations

import numpy as np
import pytest

from flexspline.results.figures.diagnosis.panels import BINS, means


def test_a_branch_that_few_large_cycles_reach_has_a_line_to_its_end() -> None:
    """Two small cycles and one large: beyond the small ones values lie 5 % of the range apart."""
    x = np.concatenate([np.linspace(0, 2.4, 120), np.linspace(0, 12, 22)])
    found, level = means(x, 2.0 + 0 * x, few=False)
    assert len(found) == BINS
    assert found[0] < 0.3
    assert found[-1] > 8
    assert level == pytest.approx(2.0)


def test_clusters_have_a_mean_each_and_none_between_them() -> None:
    places = np.repeat([1.0, 5.0, 9.0], 20)
    x = places + 0.05 * np.random.default_rng(1).normal(size=60)
    found, level = means(x, places, few=False)
    assert found == pytest.approx([1, 5, 9], abs=0.1)
    assert level == pytest.approx([1, 5, 9])
