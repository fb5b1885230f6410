"""From a study file to a checked Study; every fault is one line with key, value and range."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from flexspline.geometry.errors import MISSING, DesignError
from flexspline.geometry.load import load_design, read_toml
from flexspline.geometry.near_key import nearest_key
from flexspline.geometry.toml_read import number_help
from flexspline.pipeline.study.check import check
from flexspline.pipeline.study.schema import KEYS, WORDS, StudyFile, pattern
from flexspline.pipeline.study.study import Study, StudyError

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

OF_DESIGN = ("name", "flexspline")
"""Keys that every design file has, and no study."""
NO_STUDY = (
    'is a key of a design; a study names its design file in design = "FILE" and says what to vary'
)


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
    check(study)
    return study


def _translated(error: ValidationError) -> StudyError:
    """The first fault in plain words; unknown keys first, since a misspelt one is also missing."""
    found = sorted(error.errors(), key=lambda e: e["type"] != "extra_forbidden")
    first, *others = map(_said, found)
    return StudyError(first.key, first.value, first.reason, others)


def _said(fault: ErrorDetails) -> StudyError:
    where = fault["loc"]
    key = ".".join(f'"{p}"' if "." in str(p) else str(p) for p in where)
    if fault["type"] == "extra_forbidden":
        known = KEYS.get(pattern(where[:-1]), ())
        if where[-1] in OF_DESIGN and len(where) == 1:
            return StudyError(key, fault["input"], NO_STUDY)
        near = nearest_key(str(where[-1]), known)
        hint = f"did you mean {near}?" if near else f"known are {', '.join(known)}"
        return StudyError(key, fault["input"], f"unknown key; {hint}")
    words = WORDS.get(pattern(where), "something else")
    if fault["type"] == "missing":
        return StudyError(key, MISSING, f"give {words}")
    help_ = number_help(fault["input"]) if isinstance(fault["input"], str) else ""
    return StudyError(key, fault["input"], f"must be {words}{help_}")
