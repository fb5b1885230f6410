"""By how much a compliance changes with laws of other causes that fit as well.

No row tells these apart: whether friction takes torque at the ends of its loop or leaves the chord as it is,
or at which load a soft wind-up is as stiff as simulated. Each is the same but for a compliance.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

import numpy as np

from flexspline.pipeline.diagnosis.sweep.evidence.fit import SweepFit


def spring_changes(fit: SweepFit) -> list[np.ndarray]:
    """Of each cause that has such laws, the changes of compliance [arcsec per N·m].

    Of each of its elements by itself, and of all of them together: friction of several thresholds has one
    place.
    """
    history = fit.rig.history
    torque = history.torque_Nm
    changes_of: dict[str, list[np.ndarray]] = {}
    for term, amplitudes in zip(
        fit.regressors, fit.posterior.amplitudes(fit.evidence), strict=True
    ):
        others = term.cause.but_for_a_spring(term.shape, fit.rig) if term.cause else []
        if term.cause is None or not others:
            continue
        mine = term.cause.columns(term.shape, history) @ amplitudes
        left = [mine - term.cause.columns(o, history) @ amplitudes for o in others]
        changes = [float(torque @ own) / float(torque @ torque) for own in left]
        changes_of.setdefault(term.owner, []).append(np.array(changes))
    return [_with_all(each) for each in changes_of.values()]


def spring_std(fit: SweepFit, weigh: Callable[[np.ndarray], np.ndarray] = np.ones_like) -> float:
    """Deviation of the compliance [arcsec per N·m] by such laws, those of one cause apart from another's.

    `weigh` : how likely changes (k,) are, beside none. Alike where what the prior says of larger springs is
    no evidence of the smaller.
    """
    total = 0.0
    for changes in spring_changes(fit):
        likely = weigh(changes)
        total += float(likely @ np.square(changes)) / (1 + float(likely.sum()))
    return sqrt(total)


def _with_all(each: list[np.ndarray]) -> np.ndarray:
    """Changes of elements, and of all together where each has one."""
    single = np.concatenate(each)
    together = len(each) > 1 and all(len(own) == 1 for own in each)
    return np.append(single, single.sum()) if together else single
