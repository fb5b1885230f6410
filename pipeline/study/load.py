"""From a study file to a checked Study; every fault is one line with key, value and range."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from flexspline.geometry.design import Design
from flexspline.geometry.errors import MISSING, DesignError
from flexspline.geometry.keys import STEP, has_table_of, value_at
from flexspline.geometry.load import load_design, read_toml
from flexspline.geometry.schema import Location, allowed, node_at
from flexspline.pipeline.study.figures import FIGURES, TOTAL, USUAL_FIGURES, not_a_figure
from flexspline.pipeline.study.schema import KEYS, WORDS, Span, Spread, StudyFile, pattern

SPREAD = "backlash_arcsec.std"


SMALLEST_SPREAD = 1e-6
"""Of the value: no gauge tells a part in a million, and differences of K drown in rounding."""


class StudyError(DesignError):
    """A study file that cannot be accepted: key, value, and what would work."""


@dataclass(frozen=True)
class Study:
    """A study that was read and checked, and the design that it varies."""

    name: str
    file: StudyFile
    design: Design

    @cached_property
    def whole(self) -> frozenset[str]:
        """Keys that hold whole numbers."""
        return frozenset(k for k in self.file.vary if is_whole(self.design, k))

    @property
    def keys(self) -> tuple[str, ...]:
        """The design keys whose values change from design to design."""
        return (*self.file.vary, *self.file.link, *self.file.tolerance)

    @property
    def asked(self) -> frozenset[str]:
        """The figures that a design must have: objectives and constraints, else the usual ones."""
        if self.file.run.method == "tolerance":
            return frozenset(self.outputs)
        return frozenset({**self.file.objective, **self.file.constraint} or USUAL_FIGURES)

    @property
    def outputs(self) -> tuple[str, ...]:
        """The figures whose scatter a tolerance study tells: the objectives, or the backlash."""
        return tuple(self.file.objective) or (TOTAL,)

    def is_answered(self, figures: Mapping[str, float]) -> bool:
        """Whether a design has every figure asked for; what else could not be solved costs only itself."""
        return self.asked <= figures.keys()


def load_study(path: Path) -> Study:
    """Read, validate and check a study file and its design.

    Raises
    ------
    DesignError : the study file (`StudyError`) or its design is wrong; one line.
    """
    return study_from(read_toml(path, "study"), path.parent, path.stem)


def study_from(data: Mapping[str, Any], folder: Path, name: str) -> Study:
    """A checked Study from the tables of a study file; the design's path is relative to `folder`."""
    try:
        file = StudyFile.model_validate(data)
    except ValidationError as fault:
        raise _translated(fault) from None
    try:
        design = load_design(folder / file.design)
    except DesignError as fault:
        raise StudyError("design", file.design, str(fault)) from None
    study = Study(name, file, design)
    _check(study)
    return study


def location_of(key: str) -> Location:
    """``shaft.segment[1].length_mm`` → ("shaft", "segment", 1, "length_mm")."""
    parts: list[str | int] = []
    for name in key.split("."):
        match = STEP.fullmatch(name)
        if match is None:
            parts.append(name)
            continue
        parts.append(match[1])
        if match[2] is not None:
            parts.append(int(match[2]))
    return tuple(parts)


def is_whole(design: Design, key: str) -> bool:
    """Whether a design key holds a whole number."""
    return node_at(location_of(key), design.flexspline.kind).get("type") == "integer"


def _check(study: Study) -> None:
    file, method = study.file, study.file.run.method
    for key, span in file.vary.items():
        _check_design_key(study, "vary", key)
        _check_span(study, key, span)
    for key, link in file.link.items():
        _check_design_key(study, "link", key)
        if link.of not in {**file.vary, **file.tolerance}:
            raise StudyError(f'link."{key}".of', link.of, "must be a key of [vary] or [tolerance]")
        if key in file.vary:
            raise StudyError(f'link."{key}"', link.of, "the same key stands in [vary]; keep one")
    for key, spread in file.tolerance.items():
        _check_design_key(study, "tolerance", key)
        if (spread.plus_minus is None) == (spread.std is None):
            raise StudyError(f'tolerance."{key}"', {}, f"must be {WORDS['tolerance.*']}")
        _check_spread(study, key, spread)
    for table in ("objective", "constraint"):
        for key in getattr(file, table):
            if key not in FIGURES:
                raise StudyError(f'{table}."{key}"', {}, not_a_figure(key))
            if key == SPREAD and not _always_stated(study):
                reason = "needs a standard deviation above 0 in the design's [uncertainty]"
                raise StudyError(f'{table}."{key}"', {}, reason)
    for key, limit in file.constraint.items():
        low, high = limit.min, limit.max
        if low is None and high is None:
            raise StudyError(f'constraint."{key}"', {}, f"must be {WORDS['constraint.*']}")
        if low is not None and high is not None and low > high:
            raise StudyError(f'constraint."{key}".min', low, f"must be at most max = {high:g}")
    if method == "tolerance":
        if file.vary:
            key = next(iter(file.vary))
            raise StudyError(
                f'vary."{key}"', {}, 'method "tolerance" takes [tolerance] instead of [vary]'
            )
    elif not file.vary:
        raise StudyError("vary", MISSING, "give at least one design key to vary")
    elif file.tolerance:
        key = next(iter(file.tolerance))
        raise StudyError(f'tolerance."{key}"', {}, 'needs method = "tolerance"')
    if file.run.verify and not file.objective:
        reason = "must be 0 without an [objective], which says what is best"
        raise StudyError("run.verify", file.run.verify, reason)
    if method == "optimize" and not file.objective:
        raise StudyError("objective", MISSING, 'method "optimize" needs at least one figure')


def _always_stated(study: Study) -> bool:
    """Whether some source of doubt is above 0 in every design of the study."""
    file = study.file
    for key, std in study.design.uncertainty:
        name = f"uncertainty.{key}"
        least = file.vary[name].ends[0] if name in file.vary else std
        if name not in file.link and least > 0:
            return True
    return False


def _check_design_key(study: Study, table: str, key: str) -> None:
    kind = study.design.flexspline.kind
    node = node_at(location_of(key), kind)
    if node.get("type") in ("number", "integer") and has_table_of(study.design, key):
        if table != "tolerance" or value_at(study.design, key) is not None:
            return
        reason = "has no value in the design file that could scatter; state it there"
        raise StudyError(f'tolerance."{key}"', {}, reason)
    known = _numeric_keys(study.design)
    near = get_close_matches(key[:200], known, n=1, cutoff=0.6)
    reason = f"did you mean {near[0]}?" if near and near[0] != key else f"e.g. {known[0]}"
    raise StudyError(f'{table}."{key}"', {}, f"is no number of the design file; {reason}")


def _check_spread(study: Study, key: str, spread: Spread) -> None:
    """Neither lost in rounding beside the value, nor beyond all that the key may hold."""
    name, amount = (
        ("std", spread.std) if spread.plus_minus is None else ("plus_minus", spread.plus_minus)
    )
    node = node_at(location_of(key), study.design.flexspline.kind)
    value = value_at(study.design, key)
    least = SMALLEST_SPREAD * max(abs(float(value or 0)), float(node["minimum"])) or SMALLEST_SPREAD
    most = float(node["maximum"])
    if amount is None or not least <= amount <= most:
        reason = f"must be a number from {least:g} to {most:g}"
        raise StudyError(f'tolerance."{key}".{name}', amount, reason)


def _numeric_keys(design: Design) -> list[str]:
    found: list[str] = []

    def walk(prefix: str, value: Any) -> None:
        if isinstance(value, dict):
            for name, inner in value.items():
                walk(f"{prefix}.{name}" if prefix else name, inner)
        elif isinstance(value, list):
            for i, inner in enumerate(value):
                walk(f"{prefix}[{i}]", inner)
        elif isinstance(value, int | float) and not isinstance(value, bool):
            found.append(prefix)

    walk("", design.model_dump(mode="json", exclude_none=True))
    return found


def _check_span(study: Study, key: str, span: Span) -> None:
    name = f'vary."{key}"'
    listed = span.values is not None
    if listed and (span.min, span.max, span.steps) != (None, None, None):
        raise StudyError(name, span.model_dump(exclude_none=True), f"must be {WORDS['vary.*']}")
    if not listed and (span.min is None or span.max is None):
        missing = "min" if span.min is None else "max"
        raise StudyError(f"{name}.{missing}", MISSING, f"give {WORDS['vary.*']}")
    low, high = span.ends
    if not listed and low >= high:
        raise StudyError(f"{name}.min", low, f"must be below max = {high:g}")
    node = node_at(location_of(key), study.design.flexspline.kind)
    for value in span.values or span.ends:
        if is_whole(study.design, key) and value != int(value):
            raise StudyError(name, value, "must hold whole numbers")
        least = float(node["minimum"])
        most = float(node.get("maximum", value))
        if not least <= value <= most:
            words = allowed(location_of(key), study.design.flexspline.kind)
            raise StudyError(name, value, f"must be {words}")


def _translated(error: ValidationError) -> StudyError:
    """The first fault in plain words; unknown keys first, since a misspelt one is also missing."""
    found = sorted(error.errors(), key=lambda e: e["type"] != "extra_forbidden")
    first = found[0]
    where = tuple(p for p in first["loc"])
    key = ".".join(f'"{p}"' if "." in str(p) else str(p) for p in where)
    more = len(found) - 1
    if first["type"] == "extra_forbidden":
        table = pattern(where[:-1])
        known = KEYS.get(table, ())
        near = get_close_matches(str(where[-1])[:200], known, n=1, cutoff=0.6)
        hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"
        return StudyError(key, first["input"], f"unknown key; {hint}", more)
    words = WORDS.get(pattern(where), "something else")
    if first["type"] == "missing":
        return StudyError(key, MISSING, f"give {words}", more)
    return StudyError(key, first["input"], f"must be {words}", more)
