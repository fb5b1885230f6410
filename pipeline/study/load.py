"""From a study file to a checked Study; every fault is one line with key, value and range."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import load_design, read_toml
from flexspline.geometry.plain_words import FileWords, refusal, unknown_key
from flexspline.geometry.schema import Location
from flexspline.pipeline.study.check import check
from flexspline.pipeline.study.schema import KEYS, WORDS, StudyFile, pattern
from flexspline.pipeline.study.study import Study, StudyError

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
    """Return a checked Study from the tables of a study file; the design's path is relative to `folder`."""
    try:
        file = StudyFile.model_validate(data)
    except ValidationError as fault:
        raise refusal(fault.errors(), FileWords(_name, _allowed, _unknown), StudyError) from None
    try:
        design = load_design(folder / file.design)
    except DesignError as fault:
        raise StudyError("design", file.design, str(fault)) from None
    study = Study(name, file, design)
    check(study)
    return study


def _name(location: Location) -> str:
    return ".".join(f'"{p}"' if "." in str(p) else str(p) for p in location)


def _allowed(location: Location) -> str:
    return WORDS.get(pattern(location), "something else")


def _unknown(location: Location) -> str:
    *table, key = location
    if not table and key in OF_DESIGN:
        return NO_STUDY
    known = KEYS.get(pattern(tuple(table)), ())
    return unknown_key(str(key), known, f"[{_name(tuple(table))}]" if table else "a study")
