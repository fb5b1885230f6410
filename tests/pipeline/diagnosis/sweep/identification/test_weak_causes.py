"""What is worth its place: two causes that explain alike are rivals, unless neither beats their absence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from histories import LARGEST, PREDICTION, sweep

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.measurement.noise import Noise
from flexspline.pipeline.diagnosis.sweep.evidence.beam_search import Search
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import (
    GaussianEvidence,
    gaussian_evidence,
)
from flexspline.pipeline.diagnosis.sweep.evidence.regressors import design_matrix
from flexspline.pipeline.diagnosis.sweep.identification.identification import (
    ALONE_NATS,
    STAND_IN_NATS,
    Identification,
    identify,
)

GROWTH = {"wear", "thermal_clearance"}
HISTORY = sweep(cycles=6, hold=0)
WARMING = replace(HISTORY, temperature_C=20.0 + 3.0 * HISTORY.cycle, input_angle_deg=None)
"""3 K warmer in each cycle: a gap that grows with either is the same."""


def raced(growth_arcsec: float) -> GaussianEvidence:
    """A spring of 40 % left out, and a gap that grows; what noise would do is its deviation alone."""
    torque = WARMING.torque_Nm
    added = 4.0 * torque + growth_arcsec * WARMING.cycle / 5 * np.sign(torque) / 2
    known = {k: known_causes()[k] for k in ("series_compliance", *GROWTH)}
    columns = design_matrix(FitContext(PREDICTION, WARMING), known)
    return gaussian_evidence(columns, added, np.abs(torque) > 0.07 * LARGEST, Noise(1.0, 0.0, 0.5))


def identified(evidence: GaussianEvidence) -> Identification:
    search = Search(evidence)
    search.run()
    return identify(search)


@pytest.mark.parametrize("growth", np.arange(0.6, 3.0, 0.2))
def test_a_cause_is_named_where_it_beats_all_without_it_and_its_rivals(growth: float) -> None:
    evidence = raced(float(growth))
    found = identified(evidence)
    bare = Search(evidence, lambda t: t.owner not in GROWTH).run()
    unnamed = any(evidence.terms[i].cause is None for i in bare.terms)
    # a spring has one shape: it leaves nothing that a growing gap could be
    needed = STAND_IN_NATS if unnamed else ALONE_NATS
    worth = max(c.score for c in found.search.best.values()) - bare.score
    assert bool(GROWTH & set(found.named)) == (worth >= needed)


def test_what_is_worth_it_has_the_other_for_a_rival() -> None:
    found = identified(raced(6.0))
    (one,) = GROWTH & set(found.named)
    assert set(found.rivals[one]) == GROWTH - {one}
