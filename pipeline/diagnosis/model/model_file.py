"""Reads extended_model.toml and checks everything in it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from flexspline.geometry.input_file import LARGEST_TOML_BYTES, InputFileError, read_input
from flexspline.geometry.toml_read import TomlError, toml_tables
from flexspline.pipeline.diagnosis.bend import Bend
from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Element, Shape
from flexspline.pipeline.diagnosis.measurement.errors import ModelFileError
from flexspline.pipeline.diagnosis.measurement.table import LARGEST_NUMBER
from flexspline.pipeline.diagnosis.model.doubt import PredictionUncertainty
from flexspline.pipeline.diagnosis.model.doubt_file import read_doubt
from flexspline.pipeline.diagnosis.model.extended_model import ExtendedModel
from flexspline.pipeline.diagnosis.model.model_keys import (
    BEND,
    CALIBRATED,
    CAUSE,
    CAUSE_OPTIONAL,
    ELEMENT,
    GAIN,
    ORIGIN,
    OWN,
    PROVENANCE,
    PROVENANCE_OPTIONAL,
    TOP,
    TOP_OPTIONAL,
    UNIT,
    Refuse,
    check,
    is_number,
    tables,
)
from flexspline.pipeline.diagnosis.model.shape_check import fault_of

FORMAT = 1
"""Version of the file format. It grows when a key changes its meaning."""


@dataclass(frozen=True)
class Provenance:
    """Where a model comes from.

    Attributes
    ----------
    measurement_sha256 : of the measurement's bytes. time_recorded : where it had no time, rows count
        as seconds. first_cycle, first_time_s : of each unit's record in the file, by the unit's name;
        absent where not recorded. design_digests : of the design's tables, by name
        (`design_digest.py`); empty in files of earlier versions.
    """

    program: str
    design: str
    measurement: str
    measurement_sha256: str
    verdict: str
    K_b_Nm_per_rad: float
    K_e_Nm_per_rad: float
    time_recorded: bool
    first_cycle: Mapping[str, float]
    first_time_s: Mapping[str, float]
    design_digests: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class ModelFile:
    """A model, where it comes from, and what its predictions may be off by (None: the file does not say).

    `alternatives` are, by a cause's id, the causes that its record cannot tell from it.
    """

    path: Path
    model: ExtendedModel
    provenance: Provenance
    doubt: PredictionUncertainty | None = None
    alternatives: Mapping[str, tuple[str, ...]] = field(default_factory=dict)


def read_model_file(path: Path) -> ModelFile:
    """Read an extended model.

    Raises
    ------
    ModelFileError : unreadable, no TOML, unknown or missing keys, wrong types, unknown causes or
        shapes, an amplitude that its cause forbids.
    """

    def refuse(reason: str) -> ModelFileError:
        return ModelFileError(path, reason)

    data = _toml(path)
    _check_keys(data, refuse)
    units = {u["name"]: u for u in data["unit"]}
    if len(units) != len(data["unit"]):
        raise refuse("a unit's name appears twice")
    elements, alternatives = _causes(data, refuse)
    own = {
        name: (
            float(u.get("own_compliance_arcsec_per_Nm", 0.0)),
            float(u.get("own_gap_arcsec", 0.0)),
        )
        for name, u in units.items()
        if set(u) & set(OWN)
    }
    model = ExtendedModel(
        float(data["calibrated"]["compliance_arcsec_per_Nm"]),
        float(data["calibrated"]["gap_arcsec"]),
        {name: float(u["zero_arcsec"]) for name, u in units.items()},
        elements,
        own,
        _bend(data["bend"], refuse) if "bend" in data else None,
    )
    provenance = _provenance(data["provenance"], units, refuse)
    doubt = read_doubt(data["doubt"], model, refuse) if "doubt" in data else None
    return ModelFile(path, model, provenance, doubt, alternatives)


def _check_keys(data: Mapping[str, Any], refuse: Refuse) -> None:
    """Refuse what is no extended model of this format, and missing or unknown keys."""
    if "flexspline" in data:
        raise refuse(
            "is a design file, not an extended model; `diagnose` writes extended_model.toml"
        )
    check(data, TOP, TOP_OPTIONAL, "the model", lambda r: refuse(f"is not an extended model: {r}"))
    if data["format"] != FORMAT:
        raise refuse(f"format = {data['format']}: this program reads format {FORMAT}")
    origin, calibrated = data["provenance"], data["calibrated"]
    check(origin, PROVENANCE, PROVENANCE_OPTIONAL, "[provenance]", refuse)
    if "gain" in origin:
        check(origin["gain"], GAIN, {}, "[provenance.gain]", refuse)
    check(calibrated, CALIBRATED, {}, "[calibrated]", refuse)
    if calibrated["compliance_arcsec_per_Nm"] <= 0:
        raise refuse("calibrated.compliance_arcsec_per_Nm must be above 0")
    for table in tables(data["unit"], "unit", refuse):
        check(table, UNIT, OWN | ORIGIN, "[[unit]]", refuse)


def _causes(
    data: Mapping[str, Any], refuse: Refuse
) -> tuple[dict[str, tuple[Element, ...]], dict[str, tuple[str, ...]]]:
    """Each cause's elements and rivals, by its id."""
    elements: dict[str, tuple[Element, ...]] = {}
    alternatives: dict[str, tuple[str, ...]] = {}
    for table in tables(data.get("cause", []), "cause", refuse):
        check(table, CAUSE, CAUSE_OPTIONAL, "[[cause]]", refuse)
        if table["id"] in elements:
            raise refuse(f"cause {table['id']} appears twice")
        elements[table["id"]] = _elements(table, refuse)
        if rivals := table.get("alternatives"):
            alternatives[table["id"]] = _texts(rivals, "alternatives in [[cause]]", refuse)
    return elements, alternatives


def _provenance(
    origin: Mapping[str, Any], units: Mapping[str, Mapping[str, Any]], refuse: Refuse
) -> Provenance:
    given = {key: origin[key] for key in PROVENANCE}
    cycle, time = ({name: float(u[key]) for name, u in units.items() if key in u} for key in ORIGIN)
    digests = origin.get("design_digests", {})
    _texts(digests.values(), "design_digests in [provenance]", refuse)
    return Provenance(**given, first_cycle=cycle, first_time_s=time, design_digests=dict(digests))


def _texts(values: Iterable[object], where: str, refuse: Refuse) -> tuple[str, ...]:
    texts = tuple(values)
    if not all(isinstance(v, str) for v in texts):
        raise refuse(f"{where} must be texts")
    return tuple(map(str, texts))


def _bend(table: Mapping[str, Any], refuse: Refuse) -> Bend:
    check(table, BEND, {}, "[bend]", refuse)
    torque, angle = table["torque_Nm"], table["angle_arcsec"]
    if not all(map(is_number, (*torque, *angle))) or len(torque) != len(angle) or len(torque) < 2:
        raise refuse("torque_Nm and angle_arcsec in [bend] must be as many numbers, two or more")
    if torque[0] != 0 or any(b <= a for a, b in pairwise(torque)):
        raise refuse("torque_Nm in [bend] must rise from 0")
    return Bend(tuple(map(float, torque)), tuple(map(float, angle)))


def _toml(path: Path) -> dict[str, Any]:
    try:
        return toml_tables(read_input(path, LARGEST_TOML_BYTES, "an extended model"))
    except (InputFileError, TomlError) as error:
        raise ModelFileError(path, str(error)) from None


def _elements(table: Mapping[str, Any], refuse: Refuse) -> tuple[Element, ...]:
    name = table["id"]
    cause = known_causes().get(name)
    if cause is None:
        raise refuse(f'"{name}" is not a known cause; known are {", ".join(known_causes())}')
    elements = []
    for element in tables(table["element"], "cause.element", refuse):
        check(element, ELEMENT, {}, f"element of {name}", refuse)
        amplitudes = element["amplitudes"]
        if not amplitudes or not all(is_number(a) for a in amplitudes):
            raise refuse(f"amplitudes of {name} must be numbers within ±{LARGEST_NUMBER:g}")
        if cause.positive and min(amplitudes) < 0:
            raise refuse(f"an amplitude of {name} is negative, which physics forbids")
        shape: Shape = element["shape"]
        for key, value in shape.items():
            if not is_number(value):
                raise refuse(
                    f"{key} in a shape of {name} must be a number within ±{LARGEST_NUMBER:g}"
                )
        fault = fault_of(cause, shape, len(amplitudes))
        if fault:
            raise refuse(f"a shape of {name} {fault}")
        elements.append(Element(dict(shape), tuple(float(a) for a in amplitudes)))
    if not elements:
        raise refuse(f"cause {name} has no element")
    return tuple(elements)
