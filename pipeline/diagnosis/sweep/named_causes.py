"""From a decided race to named causes with magnitudes, and the model that they make."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.creep import CREEP
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.causes.sensor_drift import DRIFT
from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.causes.torque_offset import OFFSET
from flexspline.pipeline.diagnosis.decision import (
    EVEN_ODDS,
    beside_unweighed,
    probability,
    probability_of_gain,
)
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.sweep.evidence.fit import fit_regressors
from flexspline.pipeline.diagnosis.sweep.identification.creep_or_lag import (
    creep_explains,
    lag_explains,
)
from flexspline.pipeline.diagnosis.sweep.identification.dashpot import dashpot_explains
from flexspline.pipeline.diagnosis.sweep.identification.drift_or_temperature import (
    may_follow_temperature,
)
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification
from flexspline.pipeline.diagnosis.sweep.identification.plausible_sets import explanations
from flexspline.pipeline.diagnosis.sweep.identification.rate_independence import (
    LOOPS,
    at_one_rate_on_ramps,
    loop_tells,
)
from flexspline.pipeline.diagnosis.sweep.magnitudes.magnitudes import magnitudes
from flexspline.pipeline.diagnosis.sweep.magnitudes.rounding_error import RoundingError
from flexspline.pipeline.diagnosis.sweep.magnitudes.shared_size import shared_std
from flexspline.pipeline.diagnosis.sweep.race.race import ExplainedSweep
from flexspline.pipeline.diagnosis.sweep.rig_faults.torque_zero_drift import zero_moves

SLOPE_OPEN_SHARE, SLOPE_NARROWED_SHARE = 0.6, 0.5
"""Of the simulated compliance's deviation, what is left beside friction and without it: friction then stands
for the elastic twist. Of 26 made-up records of friction alone none leaves more than 0.51; of a gear of 0.7 of
the simulated stiffness beside friction 0.67 was left."""
LAW_UNSURE = 0.02
"""Of the torque that friction ahead of the gap carries, by the law by which it slides. Of 24 made-up records
68 % of the sizes were within 2.2 % of the truth, 95 % within 4.4 %, the noise's share in it."""


def named_causes(explained: ExplainedSweep) -> tuple[NamedCause, ...]:
    """The causes identified, the offset of the torque reading among them."""
    identified = explained.identified
    evidence = identified.search.evidence
    sets = [(c.named(evidence), c.score) for c in explanations(evidence, identified.search)]
    magnitude, std = magnitudes(identified)
    rounding = RoundingError.of(explained.prepared, identified.fit)
    slopes = identified.fit.magnitude_slopes()
    timed = explained.prepared.sweep.history.time_s is not None
    decided = loop_tells(evidence, identified.best, timed)
    ahead = explained.ahead
    units = explained.prepared.sweep.units
    named = []
    for c in identified.named:
        unweighed = tuple(_other_rivals(explained, c, decided, timed))
        shares = explained.shares.get(c)
        rivals = (*identified.rivals[c], *unweighed)
        chance = probability(c, sets)
        # where likelier explanations do without it, its gain over others says nothing
        nats = identified.evidence_nats.get(c, 0.0) if chance >= EVEN_ODDS else 0.0
        if c == FRICTION and ahead is not None:
            chance, nats = probability_of_gain(ahead.nats), ahead.nats
            std[c] = hypot(std[c], _std_ahead_arcsec(explained))
        std[c] = hypot(
            std[c], shared_std(identified, c, magnitude, rivals), rounding.std(slopes[c])
        )
        named.append(
            NamedCause(
                c,
                probability=beside_unweighed(chance, unweighed),
                alternatives=tuple(dict.fromkeys(rivals)),
                magnitude=magnitude[c],
                magnitude_std=std[c],
                unit=known_causes()[c].unit,
                evidence_nats=nats,
                rms_arcsec=identified.rms[c],
                own_units=tuple(units[u] for u in shares.own) if shares else (),
                ahead_Nm=_ahead_Nm(explained, c),
                ahead_std_Nm=_ahead_std_Nm(explained, c),
                widest_arcsec=identified.fit.widest_loop_arcsec() if c == FRICTION else None,
                or_temperature=c == DRIFT and may_follow_temperature(identified),
            )
        )
    if explained.offset_Nm and explained.crossing is not None:
        offset = known_causes()[OFFSET]
        slope = identified.fit.measured_rig().compliance
        named.append(
            NamedCause(
                offset.id,
                probability=probability_of_gain(explained.offset_nats),
                alternatives=(),
                magnitude=explained.offset_Nm,
                magnitude_std=hypot(
                    explained.crossing.std_Nm, offset.shape_doubt * explained.offset_Nm
                ),
                unit=offset.unit,
                evidence_nats=explained.offset_nats,
                rms_arcsec=abs(slope * explained.offset_Nm),
            )
        )
    return tuple(named)


def _other_rivals(
    explained: ExplainedSweep, cause: str, decided: bool, timed: bool
) -> Iterator[str]:
    """Rivals that no race of explanations shows; `decided`, `timed`: as `loop_tells` has them."""
    identified = explained.identified
    if cause in LOOPS and not decided and not (cause == FRICTION and timed and explained.ahead):
        yield LOOPS[cause]
    if cause == FRICTION and SERIES not in identified.named and _stands_for_springs(identified):
        if at_one_rate_on_ramps(explained.prepared.rig.history):
            yield RATE  # so does a lag as long as a ramp
        yield SERIES
    if cause == FRICTION and RATE in identified.named and dashpot_explains(identified):
        yield RATE  # of a low power, alone
    if cause == RATE and creep_explains(identified):
        yield CREEP
    if cause == CREEP and RATE not in identified.rivals[CREEP] and lag_explains(identified):
        yield RATE
    if cause == DRIFT and zero_moves(explained):
        yield OFFSET


def _stands_for_springs(identified: Identification) -> bool:
    """Whether the record fixes the compliance without friction, and does not beside it.

    Friction that never saturates then takes up elastic twist: a spring left out looks the same. All else is
    beside both: a stiffness of few positions or a soft wind-up may leave the compliance open too, and is no
    friction; nor is what carries torque ahead of the teeth, which takes up no twist.
    """
    evidence, fit = identified.search.evidence, identified.fit
    ahead = evidence.columns.ahead is not None
    if not ahead and identified.rms[FRICTION] > fit.widest_loop_arcsec():
        return True  # no loop is so: what never slides is a spring
    stated = float(evidence.columns.base_prior[fit.units])
    others = [i for i in identified.best.terms if evidence.terms[i].owner != FRICTION]
    alone = fit_regressors(evidence, others).calibration.compliance
    beside = fit.calibration.compliance
    assert alone is not None
    assert beside is not None
    return alone.std < SLOPE_NARROWED_SHARE * stated and beside.std > SLOPE_OPEN_SHARE * stated


def _std_ahead_arcsec(explained: ExplainedSweep) -> float:
    """What the doubt of the torque carried ahead of the teeth makes of the loop's width.

    That of the law by which it slides, and that of its size, unless friction elements behind the gap are
    fitted beside it: they take up what it leaves.
    """
    fit = explained.identified.fit
    own = _ahead_std_Nm(explained, FRICTION)
    if FRICTION in explained.identified.best.named(fit.evidence):
        own = LAW_UNSURE * _ahead_Nm(explained, FRICTION)
    return 2 * fit.measured_rig().compliance * own


def _ahead_std_Nm(explained: ExplainedSweep, cause: str) -> float:
    """Deviation of that torque, by its fit and by the law by which it slides; 0 of other causes."""
    if explained.ahead is None or cause != FRICTION:
        return 0.0
    return hypot(explained.ahead.torque_std_Nm, LAW_UNSURE * _ahead_Nm(explained, cause))


def _ahead_Nm(explained: ExplainedSweep, cause: str) -> float:
    """Torque that friction takes ahead of the teeth; 0 of other causes."""
    ahead = explained.prepared.ahead if explained.ahead and cause == FRICTION else None
    return ahead.amplitudes[0] if ahead else 0.0
