"""What the best set leaves without a name: nuisance terms, minor causes, and structure in the residual."""

from __future__ import annotations

from collections.abc import Sequence

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.outcome import Unexplained
from flexspline.pipeline.diagnosis.sweep.identification import Identification
from flexspline.pipeline.diagnosis.sweep.jumps import Jumps
from flexspline.pipeline.diagnosis.sweep.residual_tests import SIGNIFICANT, ChannelTest

NUISANCE_P = 1e-6
"""Said of a nuisance term in the best set: it had to gain more than this over chance to get there."""

JUMPING = "jumps with the torque's motion; something sticks and breaks away"


def unexplained_of(
    identified: Identification, tests: Sequence[ChannelTest], jumps: Jumps | None = None
) -> tuple[Unexplained, ...]:
    """Nuisance terms and minor causes of the best set, jumps, and channels where the rest is significant."""
    found = []
    regressors = [identified.search.evidence.terms[i] for i in identified.best.terms]
    for owner, rms in sorted(identified.rms.items(), key=lambda item: -item[1]):
        if owner.startswith("?"):
            what = "; ".join(sorted({r.what for r in regressors if r.owner == owner}))
            found.append(Unexplained(owner[1:], rms, NUISANCE_P, what))
        elif owner not in identified.named:
            trace = f"a trace like {known_causes()[owner].title}"
            found.append(Unexplained("torque_Nm", rms, NUISANCE_P, trace))
    if jumps is not None:
        found.append(Unexplained("direction", jumps.rms_arcsec, jumps.p_value, JUMPING))
    said = {u.channel for u in found}
    for t in sorted(tests, key=lambda t: t.p_value):
        if t.p_value < SIGNIFICANT and t.channel not in said:
            found.append(
                Unexplained(t.channel, t.rms_arcsec, t.p_value, "what the best model leaves")
            )
    return tuple(found)
