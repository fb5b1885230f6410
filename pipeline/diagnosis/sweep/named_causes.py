"""From a decided race to named causes with magnitudes, and the model that they make."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Element
from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.sweep.decision import Decision
from flexspline.pipeline.diagnosis.sweep.fit import SweepFit, fit_regressors
from flexspline.pipeline.diagnosis.sweep.offset_race import ExplainedSweep

SHAPE_NATS = 3.0
"""Sets of shapes count in a magnitude's doubt by exp(−nats/3): no shape is exactly the gear's."""
MOST_SHAPES = 24


def named_causes(explained: ExplainedSweep) -> tuple[NamedCause, ...]:
    """The causes of a decided race, largest first, the offset of the torque reading among them."""
    decision = explained.decision
    posterior = _probabilities(decision)
    magnitude, std = magnitudes(decision)
    timeless = explained.prepared.sweep.history.time_s is None
    found = []
    for c in decision.named:
        rivals = decision.rivals[c]
        if timeless and c in ("friction_hysteresis", "rate_dependence"):
            other = {"friction_hysteresis": "rate_dependence"}.get(c, "friction_hysteresis")
            rivals = tuple(dict.fromkeys((*rivals, other)))
        found.append(NamedCause(
            c, known_causes()[c].title_at(magnitude[c]), posterior.get(c, 0.0), rivals, magnitude[c], std[c],
            known_causes()[c].unit, decision.evidence_nats.get(c, 0.0), decision.rms[c],
            _own_units(explained, c),
        ))  # fmt: skip
    if explained.offset_Nm and explained.crossing is not None:
        offset = known_causes()["torque_offset"]
        slope = decision.fit.measured_rig().compliance
        found.append(NamedCause(
            offset.id, offset.title, float(1 / (1 + np.exp(-explained.offset_nats + 4))), (),
            explained.offset_Nm,
            hypot(explained.crossing.std_Nm, offset.shape_doubt * explained.offset_Nm),
            offset.unit, explained.offset_nats,
            abs(slope * explained.offset_Nm),
        ))  # fmt: skip
    return tuple(sorted(found, key=lambda c: -c.rms_arcsec))


def _own_units(explained: ExplainedSweep, cause: str) -> tuple[str, ...]:
    """Names of the units that alone show a cause."""
    share = explained.shares.get(cause)
    return tuple(explained.prepared.sweep.units[u] for u in share.own) if share else ()


def _probabilities(decision: Decision) -> dict[str, float]:
    """Posterior probability that each cause is in the set, over all sets weighed."""
    evidence = decision.search.evidence
    scored = list(decision.search.best.values())
    top = max(c.score for c in scored)
    weight = np.array([np.exp(c.score - top) for c in scored])
    names = [c.named(evidence) for c in scored]
    total = weight.sum()
    return {
        cause: min(1.0, float(weight[[cause in n for n in names]].sum() / total))
        for cause in decision.named
    }


def magnitudes(decision: Decision) -> tuple[dict[str, float], dict[str, float]]:
    """Magnitude of each named cause and its standard deviation, doubt of the shapes included."""
    evidence = decision.search.evidence
    names = decision.best.named(evidence)
    alike = sorted(
        {
            c.terms: c
            for c in (*decision.search.tried, decision.best)
            if c.named(evidence) == names
        }.values(),
        key=lambda c: -c.score,
    )[:MOST_SHAPES]
    alike = [c for c in alike if c.score > decision.best.score - 6 * SHAPE_NATS]
    weight = np.exp([(c.score - decision.best.score) / SHAPE_NATS for c in alike])
    weight /= weight.sum()
    each = [fit_regressors(evidence, c.terms).magnitudes() for c in alike]
    best = decision.fit.magnitudes()
    own = decision.fit.magnitude_stds()
    std = {}
    for cause in decision.named:
        values = np.array([m[cause] for m in each])
        spread = float(np.sqrt(weight @ (values - best[cause]) ** 2))
        floor = known_causes()[cause].shape_doubt * abs(best[cause])
        std[cause] = hypot(own[cause], spread, floor)
    return best, std


def model_of(fit: SweepFit, sweep: Sweep, named: Sequence[str], offset_Nm: float) -> ExtendedModel:
    """The fitted model, with the elements of the named causes."""
    mean, k, p = fit.posterior.mean, fit.units, fit.rig.prediction
    elements = {c: e for c, e in fit.elements().items() if c in named}
    if offset_Nm:
        elements["torque_offset"] = (Element({}, (offset_Nm,)),)
    own = {}
    if k > 1:
        pairs = mean[k + 2 : k + 2 + 2 * k].reshape(k, 2)
        own = {name: (float(a), float(b)) for name, (a, b) in zip(sweep.units, pairs, strict=True)}
    return ExtendedModel(
        p.compliance + float(mean[k]),
        p.gap_arcsec + float(mean[k + 1]),
        {name: float(z) for name, z in zip(sweep.units, mean[:k], strict=True)},
        elements,
        own,
    )
