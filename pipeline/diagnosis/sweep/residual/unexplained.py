"""What the best set leaves without a name: nuisance terms, minor causes, and structure in the residual."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from math import hypot

import numpy as np

from flexspline.pipeline.diagnosis.outcome import Unexplained
from flexspline.pipeline.diagnosis.structure import Trace, UnnamedForm
from flexspline.pipeline.diagnosis.sweep.identification.gear_curve_error import RIPPLED
from flexspline.pipeline.diagnosis.sweep.identification.identification import Identification
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import (
    STRUCTURE_P_VALUE,
    ChannelTest,
)
from flexspline.pipeline.diagnosis.sweep.residual.stick_slip_skewness import Jumps

NUISANCE_P = 1e-6
"""Said of a nuisance term in the best set: it had to gain more than this over chance to get there."""
JUMPS = (UnnamedForm("jumps"),)
COMES_BACK = (UnnamedForm("comes_back"),)
REMAINDER = (UnnamedForm("remainder"),)


def made_by_rounding(identified: Identification, rounding_arcsec: float) -> frozenset[str]:
    """Owners of the best set's ripples, where they are together no more than rounding leaves.

    A saw-tooth over the encoder's steps is a function of the angle.
    """
    ripples = [owner for owner in RIPPLED if owner in identified.rms]
    together = hypot(*(identified.rms[owner] for owner in ripples))
    return frozenset(ripples if together < rounding_arcsec else ())


def unexplained_of(
    identified: Identification,
    tests: Sequence[ChannelTest],
    jumps: Jumps | None = None,
    lack_of_fit: ChannelTest | None = None,
    attributed: Collection[str] = (),
    units: Sequence[str] = (),
) -> tuple[Unexplained, ...]:
    """Nuisance terms and minor causes of the best set, jumps, and channels where the rest is significant.

    `attributed` : causes that are said to be possible, as found or as rivals. `units` : names of the units.
    """
    unexplained = []
    forms = _forms(identified)
    for owner in sorted(identified.unnamed(attributed), key=lambda o: -identified.rms[o]):
        rms = identified.rms[owner]
        if owner.startswith("?"):
            named = tuple(dict.fromkeys(_as_said(f, units) for o, f in forms if o == owner))
            unexplained.append(Unexplained(owner[1:], rms, NUISANCE_P, named))
        else:
            unexplained.append(Unexplained("torque_Nm", rms, NUISANCE_P, Trace(owner)))
    if jumps is not None:
        unexplained.append(Unexplained("direction", jumps.rms_arcsec, jumps.p_value, JUMPS))
    if lack_of_fit is not None:
        unexplained.append(
            Unexplained(
                lack_of_fit.channel, lack_of_fit.rms_arcsec, lack_of_fit.p_value, COMES_BACK
            )
        )
    said = {u.channel for u in unexplained}
    for t in sorted(tests, key=lambda t: t.p_value):
        if t.p_value < STRUCTURE_P_VALUE and t.channel not in said:
            unexplained.append(Unexplained(t.channel, t.rms_arcsec, t.p_value, REMAINDER))
    return tuple(unexplained)


def _forms(identified: Identification) -> list[tuple[str, UnnamedForm]]:
    """Owner and form of each term of the best set that has no name, a bend of one side with its size."""
    evidence, posterior = identified.search.evidence, identified.fit.posterior
    forms = []
    for i, amplitudes in zip(posterior.terms, posterior.amplitudes(evidence), strict=True):
        term = evidence.terms[i]
        if term.form is None:
            continue
        form = term.form
        if form.kind == "one_sided":
            most = float(np.abs(evidence.columns.all[:, term.at]).max())
            form = replace(form, more_arcsec=float(amplitudes[0]) * most)
        forms.append((term.owner, form))
    return forms


def _as_said(form: UnnamedForm, units: Sequence[str]) -> UnnamedForm:
    """A form that one unit alone has, with that unit's name; ringing of two periods is one."""
    form = replace(form, period_s=None)
    return replace(form, name=units[form.number - 1]) if form.number and units else form
