"""The model that is written: fitted with what stands in it, and with nothing else."""

from __future__ import annotations

from collections.abc import Collection

from flexspline.pipeline.diagnosis.measurement.record import Sweep
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.sweep.fit import fit_regressors, model_of
from flexspline.pipeline.diagnosis.sweep.race import ExplainedSweep


def written_model(explained: ExplainedSweep, sweep: Sweep, named: Collection[str]) -> ExtendedModel:
    """The calibrated simulation with the named causes, by the best set's shapes.

    Where the best set has nuisance terms or minor causes beside them, zeros, stiffness, gap and amplitudes
    are fitted anew without: fitted beside terms that are left out, they make up for what is not there.
    """
    identified = explained.identified
    evidence, terms = identified.search.evidence, identified.best.terms
    kept = tuple(i for i in terms if (c := evidence.terms[i].cause) is not None and c.id in named)
    fit = identified.fit if kept == tuple(terms) else fit_regressors(evidence, kept)
    return model_of(fit, sweep, list(named), explained.offset_Nm)
