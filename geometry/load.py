"""From a design file to a checked Design; every fault is one line."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from geometry.checks import check
from geometry.design import Design
from geometry.errors import DesignFileError
from geometry.plain_words import translate
from geometry.toml_read import TomlError, toml_tables

LARGEST_BYTES = 1_000_000
"""A design takes 2 kB; a file beyond this is some other file."""


def load_design(path: Path | str) -> Design:
    """Read, validate and check a design file (TOML).

    Raises
    ------
    DesignFileError : no such file, a directory, too large, not UTF-8, not TOML.
    DesignError : unknown, missing or wrong key, or impossible geometry. Keys are dotted, array
        elements are counted from 0: ``shaft.segment[1].length_mm``.
    """
    return design_from(read_toml(path))


def read_toml(path: Path | str) -> dict[str, Any]:
    """The file's tables.

    Raises
    ------
    DesignFileError : no such file, a directory, too large, not UTF-8, not TOML.
    """
    try:
        if Path(path).is_dir():
            raise DesignFileError(path, "is a directory, not a design file")
        if not Path(path).exists():
            raise DesignFileError(path, "no such file")
        if not Path(path).is_file():
            raise DesignFileError(path, "is not a regular file")
        size = Path(path).stat().st_size
        if size > LARGEST_BYTES:
            raise DesignFileError(
                path, f"{size} bytes; a design file has at most {LARGEST_BYTES} bytes"
            )
        raw = Path(path).read_bytes()
    except (OSError, ValueError) as fault:
        if isinstance(fault, DesignFileError):
            raise
        raise DesignFileError(path, f"cannot be read ({fault})") from fault
    return tables_from(raw, path)


def tables_from(raw: bytes, name: object) -> dict[str, Any]:
    """The tables of a design file's bytes; `name` is what an error calls the file.

    Raises
    ------
    DesignFileError : too large, not UTF-8, not TOML.
    """
    if len(raw) > LARGEST_BYTES:
        raise DesignFileError(
            name, f"{len(raw)} bytes; a design file has at most {LARGEST_BYTES} bytes"
        )
    try:
        return toml_tables(raw)
    except TomlError as fault:
        raise DesignFileError(name, str(fault)) from fault


def design_from(data: Mapping[str, Any]) -> Design:
    """A checked Design from the tables of a design file.

    Raises
    ------
    DesignError : unknown, missing or wrong key, or impossible geometry.
    """
    try:
        design = Design.model_validate(data)
    except ValidationError as fault:
        raise translate(fault, data) from None
    check(design)
    return design
