"""Reads a design file and returns a checked Design; every fault is one line."""

from __future__ import annotations

import re
from collections.abc import Mapping
from copy import deepcopy
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from flexspline.geometry.checks import check
from flexspline.geometry.design import Design
from flexspline.geometry.errors import MISSING, DesignError, DesignFileError
from flexspline.geometry.input_file import LARGEST_TOML_BYTES, InputFileError, read_input
from flexspline.geometry.plain_words import kind_of, without_tag
from flexspline.geometry.ranges import is_number
from flexspline.geometry.schema import ends_of
from flexspline.geometry.toml_read import EmptyTomlError, TomlError, toml_tables


def load_design(path: Path | str) -> Design:
    """Read, validate and check a design file (TOML).

    Raises
    ------
    DesignFileError : no such file, a directory, too large, not UTF-8, not TOML.
    DesignError : unknown, missing or wrong key, or impossible geometry. Keys are dotted, array
        elements are counted from 0: ``shaft.segment[1].length_mm``.

    Examples
    --------
    >>> from flexspline import load_design
    >>> design = load_design("examples/xb1-40.toml")
    >>> design.name, design.flexspline.kind, design.gear.ratio
    ('XB1-40 cup', 'cup', 100.0)
    """
    return design_from(read_toml(path))


def read_toml(path: Path | str, what: str = "design") -> dict[str, Any]:
    """The file's tables; `what` kind of file it should be.

    Raises
    ------
    DesignFileError : no such file, not a regular file, too large, not UTF-8, not TOML.
    """
    return tables_from(read_raw(path, what), path, what)


def read_raw(path: Path | str, what: str = "design") -> bytes:
    """The file's bytes; `what` is what an error calls the file.

    Raises
    ------
    DesignFileError : no such file, not a regular file, too large.
    """
    try:
        return read_input(path, LARGEST_TOML_BYTES, f"a {what} file")
    except InputFileError as fault:
        raise DesignFileError(path, str(fault)) from None


def tables_from(raw: bytes, name: object, what: str = "design") -> dict[str, Any]:
    """The tables of a file's bytes; `name` is what an error calls the file, `what` kind it should be.

    Raises
    ------
    DesignFileError : too large, empty, not UTF-8, not TOML.
    """
    if len(raw) > LARGEST_TOML_BYTES:
        raise DesignFileError(
            name, f"{len(raw)} bytes; a {what} file has at most {LARGEST_TOML_BYTES} bytes"
        )
    try:
        return toml_tables(raw)
    except EmptyTomlError as fault:
        hint = "; `flexspline init` writes one to begin with" if what == "design" else ""
        raise DesignFileError(name, f"{fault}{hint}") from None
    except TomlError as fault:
        raise DesignFileError(name, str(fault)) from fault


def design_from(data: Mapping[str, Any]) -> Design:
    """A checked Design from the tables of a design file.

    Raises
    ------
    DesignError : unknown, missing or wrong key, or impossible geometry.
    """
    try:
        design = Design(**data)
    except DesignError as refused:
        raise _by_the_rest(refused, data) or refused from None
    check(design)
    return design


def _by_the_rest(refused: DesignError, data: Mapping[str, Any]) -> DesignError | None:
    """The same refusal with the range that the rest of the design leaves, where it can be told.

    What a key may hold by itself is wider: its nearest end would be refused again.
    """
    fault = refused.__cause__
    if refused.others or not isinstance(fault, ValidationError):
        return None
    location = without_tag(fault.errors()[0]["loc"])
    if not (ends := ends_of(location, kind_of(data))):
        return None
    tried = deepcopy(dict(data))
    table: Any = tried
    for part in location[:-1]:
        table = table[part]
    for end in _nearest(refused.value, ends):
        table[location[-1]] = end
        try:
            possible = Design(**tried)
        except DesignError:  # a fault that another one hid
            return None
        try:
            check(possible)
        except DesignError as further:
            if further.key == refused.key:
                # what another key would have to be is of the end that was tried, not of the value
                range_ = further.reason.partition("; or make that ")[0]
                reason = f"{_what(refused)}{range_}"
                return DesignError(refused.key, refused.value, reason)
    return None


def _what(refused: DesignError) -> str:
    """What the key takes at all, where it is missing or of another type."""
    noun = re.match(r"(give|must be) a (whole )?number", refused.reason)
    if noun is None:
        return ""
    ending = re.search(r", not [\w ]+(; write .*)?$", refused.reason)
    if ending is None and refused.value is not MISSING:
        return ""
    return f"{noun[0]}{ending[0] if ending else ''}; it "


def _nearest(value: object, ends: list[float]) -> list[float]:
    """The end that lies nearest to a value; all where it is no number."""
    if not is_number(value) or value != value:
        return ends
    if value >= ends[-1]:
        return ends[-1:]
    return ends[:1] if value <= ends[0] else [min(ends, key=lambda end: abs(end - value))]
