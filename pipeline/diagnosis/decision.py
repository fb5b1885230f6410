"""From the evidence of explanations to a verdict: the rules that sweeps, end points and specimens share.

Three engines give the evidence: `sweep/evidence/gaussian_evidence.py` (whitened linear model),
`end_points/evidence.py` (block covariance) and `specimens/evidence.py` (Laplace's approximation).
What follows from evidence is decided here. All log quantities are in nats. Which input of a gear
explains its curve is decided in `whole_gear/identification.py`, by chi squares of inputs that have no prior;
its two limits are here.

Of a sweep `sweep/diagnose.py` may overrule it in six places, in this order; all but the first say `unknown`,
by `overruled`:

| where | what it sees |
|---|---|
| `sweep/physical_limits.py`, `drowned` | noise or leaps above the simulated twist: `insufficient` |
| `sweep/physical_limits.py`, `broken_limit` | the explanation breaks a physical limit, or the output slips |
| `sweep/physical_limits.py`, `slow_noise` | a `consistent` record whose slow noise hides an effect |
| `sweep/rig_faults/`: `backward_loops.py`, `late_angle.py` | a torque or an angle that is read late |
| `sweep/held_out.py`, `refuted` | causes that make most levels of a channel, held out as wholes, worse |
| `sweep/held_out.py`, `unpredicted` | causes that predict nothing of cycles between others |
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import exp
from typing import Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.outcome import (
    SIZE_KNOWN,
    NamedCause,
    Unexplained,
    Verdict,
)

RIVAL_EVIDENCE = 4.0
"""[nats] (docs/contract.md) Odds of 55 to 1. A cause whose evidence is less far behind is a rival."""
RIVAL_LIKELIHOOD = 6.0
"""Nats of log likelihood less ½ log n for each amplitude (half of Schwarz's BIC), docs/contract.md."""
RIVAL_CHI_SQUARE = 6.0
"""Chi square by which another input of a gear may fit its curve worse and be a rival: 2·3 nats, odds of 20 to
1. An input has no prior and is one amplitude, so its evidence is half the chi square. Below the limits of
causes, by judgement: the inputs are five and bend the curve alike; with more rivals none would be told."""
MISFIT_P_VALUE = 0.01
"""Probability of a chi square as large, below which a gear's curve does not fit: the usual level of a test.
By chance one right curve of a hundred is said to miss something."""
EVEN_ODDS = 0.5
"""Probability at which a cause is as likely as not."""
BESIDE_UNKNOWN = 2.0
"""Times SIZE_KNOWN that a cause's size must differ from none if an effect without a known cause is present.
Free-form terms fit such an effect only roughly, and what they leave is not noise. Where a rig was bumped, 5
records of 14 had a rate dependence of 2.8 to 3.8 deviations that was not there."""
UNEXPLAINED_SHARE = 0.5
"""Of the named causes' rms, docs/contract.md: with more left unexplained the verdict is `unknown`."""

Scored = tuple[Collection[str], float]
"""The causes of an explanation, and its log evidence with its log prior."""


class RacedSet(Protocol):
    """A set of causes in a race.

    `score` : log evidence and log prior. `penalised` : log likelihood as `RIVAL_LIKELIHOOD` has it.
    """

    @property
    def causes(self) -> tuple[str, ...]: ...
    @property
    def score(self) -> float: ...
    @property
    def penalised(self) -> float: ...


E = TypeVar("E", bound=RacedSet)


@dataclass(frozen=True)
class HeldAgainst(Generic[E]):
    """A cause of the best explanation, held against all explanations of a race.

    `evidence_nats` : over the best without it. `alternatives` : causes that explain the data as well in its
    place, each with the likeliest explanation that has it there.
    """

    cause: str
    probability: float
    evidence_nats: float
    alternatives: Mapping[str, E]


@dataclass(frozen=True)
class Decision:
    """The verdict, the causes, the one of the largest effect first, and the structure that they leave."""

    verdict: Verdict
    causes: tuple[NamedCause, ...] = ()
    unexplained: tuple[Unexplained, ...] = ()


CONSISTENT = Decision("consistent")
"""Nothing beyond the noise and the stated uncertainty."""


def overruled(
    by: Unexplained, causes: Iterable[NamedCause] = (), beside: Iterable[Unexplained] = ()
) -> Decision:
    """The decision if the data refute an explanation: `unknown`, with what refutes it first."""
    return Decision("unknown", tuple(causes), (by, *beside))


def is_rival(evidence_behind: float, likelihood_behind: float) -> bool:
    """Whether an explanation so many nats behind the best one explains the data as well."""
    return evidence_behind < RIVAL_EVIDENCE or likelihood_behind < RIVAL_LIKELIHOOD


def probability(cause: str, explanations: Iterable[Scored]) -> float:
    """Posterior probability of a cause: the share of the evidence in explanations that have it."""
    scored = list(explanations)
    having = np.array([cause in causes for causes, _ in scored])
    return min(1.0, float(weights([s for _, s in scored])[having].sum()))


def held_against(
    best: E, race: Sequence[E], null: float, may_replace: Callable[[E], bool]
) -> list[HeldAgainst[E]]:
    """Each cause of the best explanation, held against all of a race, the likeliest first.

    `null` : score of the simulation by itself. `may_replace` : which explanations are of the same kind as
    the best, so that one with another cause in a cause's place may be its rival.
    """
    scored = [(e.causes, e.score) for e in race]
    near = [
        e
        for e in race
        if may_replace(e) and is_rival(best.score - e.score, best.penalised - e.penalised)
    ]
    held = []
    for cause in best.causes:
        kept = set(best.causes) - {cause}
        alternatives: dict[str, E] = {}
        for e in near:
            if cause not in e.causes and kept <= set(e.causes):
                for other in e.causes:
                    if other not in kept:
                        alternatives.setdefault(other, e)
        without = max((null, *(score for causes, score in scored if cause not in causes)))
        gain = best.score - without
        held.append(HeldAgainst(cause, probability(cause, scored), gain, alternatives))
    return held


def weights(scores: ArrayLike) -> np.ndarray:
    """(n,) posterior probabilities of explanations that exclude each other, by their log evidence."""
    likelihood = np.exp(np.subtract(scores, np.max(scores)))
    return np.asarray(likelihood / likelihood.sum())


def beside_unweighed(probability: float, rivals: Collection[str]) -> float:
    """Of a cause beside rivals that no explanation of the race stands for: even odds at most.

    Where a programme has one rate or no time, friction and a lag may make one loop; the race has weighed only
    such forms of either as it has elements for.
    """
    return min(probability, EVEN_ODDS) if rivals else probability


def probability_of_gain(nats: float) -> float:
    """Of a cause outside of the race, by its gain in evidence: RIVAL_EVIDENCE nats count as even odds.

    A shifted torque reading is such a cause, and friction ahead of the teeth: no set of the race has the same
    rows without it.
    """
    return float(1 / (1 + np.exp(RIVAL_EVIDENCE - nats)))


def chance(best: float, without: Iterable[float]) -> float:
    """p-value of an unnamed term: the odds of the likeliest explanation without it."""
    return exp(min(0.0, max(without) - best))


def is_significant(cause: NamedCause, times: float = 1.0) -> bool:
    """Whether a cause's size differs from none by more than `times` SIZE_KNOWN of its deviations.

    Sweeps ask it of each fit (`sweep/identification/significance.py`), end points and specimens of the
    best explanation.
    """
    return differs_from_none(cause.id, cause.deviations / times)


def differs_from_none(cause_id: str, deviations: float) -> bool:
    """Whether a size that is so many of its standard deviations from none differs from it significantly.

    Noise alone gives a wave an amplitude above 0; its evidence decides.
    """
    known = known_causes().get(cause_id)
    return (known is not None and not known.passes_none) or deviations >= SIZE_KNOWN


def decided(
    causes: Iterable[NamedCause],
    unexplained: Iterable[Unexplained],
    named_rms: float,
    unnamed_rms: float,
    structure: bool = False,
    sure: bool = True,
) -> Decision:
    """The decision on causes and structure found.

    Parameters
    ----------
    named_rms, unnamed_rms : of what the causes and what the terms without a name explain, in one unit.
    structure : whether the residual tests leave no doubt of structure, where nothing was found.
    sure : whether the best explanation beats the simulation by enough, and its sizes are known well enough
        (`is_significant`), to be named.
    """
    sorted_causes = tuple(sorted(causes, key=lambda c: -c.rms_arcsec))
    left = tuple(unexplained)
    if unnamed_rms > UNEXPLAINED_SHARE * named_rms:
        # a suspicion does not count beside an effect without a name
        likely = (
            c
            for c in sorted_causes
            if is_significant(c, BESIDE_UNKNOWN) and c.probability >= EVEN_ODDS
        )
        return Decision("unknown", tuple(likely), left)
    if not sorted_causes:
        return Decision("unknown", (), left) if structure else CONSISTENT
    open_ = not sure or any(c.alternatives for c in sorted_causes)
    return Decision("ambiguous" if open_ else "named", sorted_causes, left)
