"""`flexspline backlash`: the record of the four-term sum, its stiffnesses given or solved."""

from __future__ import annotations

from flexspline.geometry.sanity import warnings
from flexspline.pipeline.backlash import backlash, series_stiffness
from flexspline.pipeline.linear_limit import linear_limit
from flexspline.pipeline.stiffness_pair import given_pair, stiffness_pair
from flexspline.results.job import Job, tell_all, warn
from flexspline.results.limit_words import load_beyond
from flexspline.results.records import (
    Record,
    backlash_record,
    heading,
    linear_limit_record,
    stiffness_record,
)


def backlash_answer(job: Job, K_b: float | None, K_e: float | None) -> Record:
    """The keys of docs/contract.md; K [N·m/rad] by FE where not given. Warnings are told as they come.

    Raises
    ------
    DesignError
    NotFoundError : a stiffness that is needed failed.
    StiffnessValueError : a stiffness that is not positive and finite.
    BearingPlayDomainError : bearing play beyond c_max (involute model).
    """
    design = job.design
    record = {**heading(design), "warnings": list(warnings(design))}
    by_hand = {"K_b_Nm_per_rad": K_b, "K_e_Nm_per_rad": K_e}
    if given := {key: K for key, K in by_hand.items() if K is not None}:
        record["given"] = given
    used = given_pair(K_b, K_e) or stiffness_pair(job.context, K_b, K_e)
    if used.solved is not None:
        record |= stiffness_record(design, used.solved, job.wall_s)
        warn(design, used.solved)
    K_b, K_e = used.K_b_Nm_per_rad, used.K_e_Nm_per_rad
    K = record["K_series_Nm_per_rad"] = series_stiffness(K_b, K_e)
    limit = linear_limit(design, K)
    record["warnings"] += tell_all(load_beyond(limit, design))
    return record | backlash_record(backlash(design, K_b, K_e)) | linear_limit_record(limit)
