"""The picture of units that were diagnosed separately: an open alternative is not drawn as none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from flexspline.pipeline.diagnosis.decision import Decision
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.results.figures.diagnosis.unit_shares import shared_causes

FRICTION, RATE = "friction_hysteresis", "rate_dependence"


def cause(name: str, size: float, *rivals: str) -> NamedCause:
    return NamedCause(name, 0.9, rivals, size, 0.1, "arcsec", 5.0, size)


def shown(**units: NamedCause) -> Any:
    decisions = {unit: Decision("ambiguous", (found,)) for unit, found in units.items()}
    every = {found.id: found for found in units.values()}.values()
    apart = SimpleNamespace(
        decisions=decisions, decision=Decision("ambiguous", tuple(units.values()))
    )
    outcome = SimpleNamespace(causes=tuple(every))
    return SimpleNamespace(
        analysis=SimpleNamespace(apart=apart), diagnosis=SimpleNamespace(outcome=outcome)
    )


def test_a_unit_whose_cause_is_open_has_no_share() -> None:
    shares = shared_causes(
        shown(
            A=cause(RATE, 3.6, FRICTION), B=cause(FRICTION, 9.0, RATE), C=cause(FRICTION, 3.0, RATE)
        )
    )
    np.testing.assert_allclose(shares["Friction hysteresis"].share, [np.nan, 1.0, 1 / 3])
    np.testing.assert_allclose(shares["Rate dependence"].share, [1.0, np.nan, np.nan])


def test_a_unit_that_surely_has_none_has_a_share_of_none() -> None:
    shares = shared_causes(shown(A=cause("drift", 3.6), B=cause(FRICTION, 9.0)))
    np.testing.assert_allclose(shares["Friction hysteresis"].share, [0.0, 1.0])
