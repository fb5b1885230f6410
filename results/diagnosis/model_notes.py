"""Warnings before an extended model is used, one line each."""

from __future__ import annotations

from flexspline.geometry.design import Design
from flexspline.geometry.errors import one_line
from flexspline.geometry.listed import joined
from flexspline.pipeline.diagnosis.causes.rate_dependence import RATE
from flexspline.pipeline.diagnosis.model.design_digest import changed_tables
from flexspline.pipeline.diagnosis.model.model_file import ModelFile
from flexspline.results.diagnosis.words import title_of


def model_warnings(file: ModelFile, design: Design) -> tuple[str, ...]:
    """Whether the model is of another design, and whether its verdict leaves its causes open."""
    return (*_of_another(file, design), *_left_open(file), *_without_time(file))


def _of_another(file: ModelFile, design: Design) -> tuple[str, ...]:
    origin = file.provenance
    changed = changed_tables(design, origin.design_digests)
    if not changed and (origin.design_digests or origin.design == design.name):
        return ()
    other = f", not for {one_line(design.name)}" if origin.design != design.name else ""
    tables = f" with other values in {', '.join(f'[{name}]' for name in changed)}" * bool(changed)
    K_b, K_e = origin.K_b_Nm_per_rad, origin.K_e_Nm_per_rad
    return (
        f"the model is for {one_line(origin.design)}{other}{tables}; "
        f"its angles are for K_b {K_b:.0f} and K_e {K_e:.0f} N·m/rad",
    )


def _left_open(file: ModelFile) -> tuple[str, ...]:
    if file.provenance.verdict == "unknown":
        return (
            "the model's verdict is unknown: its record has an effect that no known cause explains,"
            " and the model does not contain this effect",
        )
    if file.provenance.verdict != "ambiguous":
        return ()
    rivals = "; ".join(
        joined(map(title_of, (cause, *others)), "or")
        for cause, others in file.alternatives.items()
        if others
    )
    return (
        "the model's verdict is ambiguous: its record does not distinguish its causes from others"
        + (f" ({rivals})" if rivals else "")
        + "; under other conditions the angles may differ",
    )


def _without_time(file: ModelFile) -> tuple[str, ...]:
    if file.provenance.time_recorded or RATE not in file.model.elements:
        return ()
    return (f"the model's record has no time: its {title_of(RATE)} takes one row as one second",)
