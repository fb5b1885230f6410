"""The extended model as a file that a person can read: TOML with comments and units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from flexspline.geometry.errors import one_line
from flexspline.geometry.toml_text import quoted
from flexspline.pipeline.backlash import ARCSEC_PER_RAD
from flexspline.pipeline.diagnosis.bend import Bend
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Element
from flexspline.pipeline.diagnosis.model.doubt import PredictionUncertainty
from flexspline.pipeline.diagnosis.model.doubt_file import doubt_lines
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.model.model_file import FORMAT, Provenance
from flexspline.pipeline.diagnosis.outcome import Gain, NamedCause

ABOUT = """\
# angle [arcsec] = zero + T·compliance + sign(T)·gap/2 + what each cause below adds; T in N·m, at the teeth.
# Each number is written in full: read back, it gives the same angles.
#   flexspline predict DESIGN.toml --model extended_model.toml TORQUE.csv
#   flexspline run DESIGN.toml --model extended_model.toml
"""


def model_text(
    model: ExtendedModel,
    provenance: Provenance,
    causes: Sequence[NamedCause] = (),
    gain: Gain | None = None,
    doubt: PredictionUncertainty | None = None,
    held_out: str = "",
) -> str:
    """The file's text; `causes` and `gain` are told beside the numbers that predict.

    `held_out` : in words, what the gain was measured on.
    """
    name = one_line(provenance.design)
    lines = [f"# Extended model of {name}, written by {provenance.program}.", ABOUT]
    lines += [
        f"format = {FORMAT}",
        "",
        *_provenance(provenance, gain, held_out),
        *_calibrated(model),
        *_bend(model.bend),
    ]
    lines += doubt_lines(doubt) if doubt is not None else []
    for unit, zero in model.zeros_arcsec.items():
        lines += _unit(unit, zero, provenance, model.own.get(unit))
    by_id = {c.id: c for c in causes}
    for cause_id, elements in model.elements.items():
        lines += _cause(cause_id, elements, by_id.get(cause_id))
    return "\n".join(lines).rstrip() + "\n"


def _provenance(p: Provenance, gain: Gain | None, held_out: str) -> list[str]:
    lines = [
        "[provenance]",
        f"program = {quoted(p.program)}",
        f"design = {quoted(p.design)}",
        f"measurement = {quoted(p.measurement)}",
        f"measurement_sha256 = {quoted(p.measurement_sha256)}",
        f"verdict = {quoted(p.verdict)}",
        f"K_b_Nm_per_rad = {number(p.K_b_Nm_per_rad)}   # of the simulation that was compared",
        f"K_e_Nm_per_rad = {number(p.K_e_Nm_per_rad)}",
        f"time_recorded = {str(p.time_recorded).lower()}"
        + ("" if p.time_recorded else "   # no time in the record: a row counts as a second"),
    ]
    if p.design_digests:
        inner = ", ".join(f"{name} = {quoted(d)}" for name, d in p.design_digests.items())
        lines.append(f"design_digests = {{ {inner} }}   # of the design's values")
    lines.append("")
    if gain is not None:
        lines += [
            "[provenance.gain]   # root mean square error on rows not used for fitting",
            f"held_out = {quoted(held_out)}",
            f"rmse_before = {number(gain.rmse_before)}   # simulation, its zero fitted",
            f"rmse_calibrated = {number(gain.rmse_calibrated)}   # stiffness and gap fitted too",
            f"rmse_after = {number(gain.rmse_after)}   # with the causes below",
            f"noise_floor = {number(gain.noise_floor)}   # noise of these readings",
            f"unit = {quoted(gain.unit)}",
            "",
        ]
    return lines


def _calibrated(model: ExtendedModel) -> list[str]:
    stiffness = ARCSEC_PER_RAD / model.compliance
    return [
        "[calibrated]   # the simulation, within the design's stated uncertainty",
        f"compliance_arcsec_per_Nm = {number(model.compliance)}   # {stiffness:.0f} N·m/rad",
        f"gap_arcsec = {number(model.gap_arcsec)}   # the whole gap, at 20 °C",
        "",
    ]


def _bend(bend: Bend | None) -> list[str]:
    if bend is None:
        return []
    torque, angle = (", ".join(map(number, of)) for of in (bend.torque_Nm, bend.angle_arcsec))
    return [
        "[bend]   # of the whole gear's simulated curve: what it adds to the line, with the sign of T",
        f"torque_Nm = [{torque}]",
        f"angle_arcsec = [{angle}]",
        "",
    ]


def _unit(name: str, zero: float, origin: Provenance, own: tuple[float, float] | None) -> list[str]:
    lines = [
        "[[unit]]",
        f"name = {quoted(name)}" + ("" if name else "   # the record names no unit"),
        f"zero_arcsec = {number(zero)}   # where the encoder stood",
    ]
    if name in origin.first_cycle:
        lines.append(f"first_cycle = {number(origin.first_cycle[name])}   # cycles count from here")
    if name in origin.first_time_s:
        lines.append(
            f"first_time_s = {number(origin.first_time_s[name])}   # drift counts from here"
        )
    if own is not None:
        lines += [
            f"own_compliance_arcsec_per_Nm = {number(own[0])}   # beyond the common one",
            f"own_gap_arcsec = {number(own[1])}",
        ]
    return [*lines, ""]


def _cause(cause_id: str, elements: Sequence[Element], named_cause: NamedCause | None) -> list[str]:
    cause = known_causes()[cause_id]
    lines = ["[[cause]]", f"id = {quoted(cause_id)}", f"title = {quoted(cause.title)}"]
    if named_cause is not None:
        lines += [
            f"magnitude = {number(named_cause.magnitude)}",
            f"magnitude_std = {number(named_cause.magnitude_std)}   # one standard deviation",
            f"unit = {quoted(named_cause.unit)}"
            + ("   # a ratio" if named_cause.unit == "1" else ""),
            f"alternatives = [{', '.join(map(quoted, named_cause.alternatives))}]",
        ]
        if named_cause.ahead_Nm:
            std = number(named_cause.ahead_std_Nm)
            lines.append(
                f"ahead_of_gap_std_Nm = {std}   # of the torque taken off T ahead of the teeth"
            )
    apart = [frozenset(s) for s in cause.searched_apart]
    for element in elements:
        ahead = "   # N·m, taken off T ahead of the teeth" * (frozenset(element.shape) in apart)
        lines += [
            "[[cause.element]]",
            f"amplitudes = [{', '.join(map(number, element.amplitudes))}]{ahead}",
            f"shape = {_inline(element.shape)}",
        ]
    return [*lines, ""]


def _inline(shape: Mapping[str, float]) -> str:
    inner = ", ".join(f"{name} = {number(value)}" for name, value in shape.items())
    return f"{{ {inner} }}" if inner else "{}"


def number(value: float) -> str:
    """A number of TOML that reads back as the same double."""
    return str(int(value)) if isinstance(value, int) else repr(float(value))
