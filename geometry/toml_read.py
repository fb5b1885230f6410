"""Reads TOML from arbitrary bytes; every fault is one clause."""

from __future__ import annotations

import codecs
import re
import tomllib
from typing import Any

from flexspline.geometry.errors import FlexsplineError
from flexspline.geometry.full_width import narrow

DEEPEST_KEY = 50
"""Parts of a dotted key; the files of this program have four. `tomllib` takes time with the square of it."""
_AT_LINE = re.compile(r"at line (\d+)")
_WITH_UNIT = re.compile(
    r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([^\W\d_][^\s#\"']*|[%°'\"µ]\S*)?\s*"
)
"""A number, and what may be the unit behind it."""
_VALUE = re.compile(r"=\s*([^#]*)")
_AGAIN = ("Cannot overwrite", "Cannot declare")
"""How `tomllib` begins where a key or a table is given twice."""
_BEGIN = re.compile(r"\s*(?:([\w\-.\"']+)\s*=|(\[[^\[\]]+\]))")
"""A key before its value, or the head of a table."""
_COMMA = re.compile(r"=\s*([+-]?\d+),(\d+)\s*(?:#.*)?$")
_STRING = re.compile(r'"(?:[^"\\\n]|\\.)*"|\'[^\'\n]*\'')
_NO_KEY = re.compile(r"[^\w\-\"' \t.]")


class TomlError(FlexsplineError, ValueError):
    """Bytes that are no TOML; the message says why."""


class EmptyTomlError(TomlError):
    """No byte, or comments alone."""


def toml_tables(raw: bytes) -> dict[str, Any]:
    """The tables of a TOML file; a mark at its start is allowed.

    Raises
    ------
    EmptyTomlError : no key in it.
    TomlError : not UTF-8, not TOML, or nested too deeply.
    """
    if raw[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE) or b"\0" in raw[:4]:
        raise TomlError("is UTF-16 or another encoding, not UTF-8 text; save it as UTF-8")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        line = raw.count(b"\n", 0, fault.start) + 1
        reason = f"is not UTF-8 text (line {line}, byte {fault.start}); save it as UTF-8"
        raise TomlError(reason) from fault
    if _deepest_key(text) > DEEPEST_KEY:
        raise TomlError("is nested too deeply")
    try:
        tables = tomllib.loads(text)
    except RecursionError as fault:
        raise TomlError("is nested too deeply") from fault
    except ValueError as fault:  # also integers of more digits than Python converts
        again = str(fault).startswith(_AGAIN)
        reason = (again and _twice(text, fault)) or f"{fault}{'' if again else _help(text, fault)}"
        raise TomlError(f"is not valid TOML: {reason}") from fault
    if not tables:
        raise EmptyTomlError("holds only comments" if text.strip() else "the file is empty")
    return tables


def number_help(text: str) -> str:
    """What to write in place of text that holds a number, with a unit or without; "" of other text."""
    match = _WITH_UNIT.fullmatch(text.strip())
    if match is None:
        return ""
    unit = ": numbers are written without unit, the key's name ends with it" if match[2] else ""
    return f"; write {match[1]}{unit}" if unit else f"; write {match[1]} without quotation marks"


def _twice(text: str, fault: ValueError) -> str:
    """The key or table that is given twice, with both lines; "" where the first is not found."""
    lines = text.rstrip().split("\n")
    at = _AT_LINE.search(str(fault))
    last = min(int(at[1]), len(lines)) if at else len(lines)
    given = _given(lines[last - 1])
    for line in range(last - 1, 0, -1):
        if given and _given(lines[line - 1]) == given:
            return f"{given} is given twice, in lines {line} and {last}"
        if not given.startswith("[") and lines[line - 1].lstrip().startswith("["):
            break
    return ""


def _given(line: str) -> str:
    """The key that a line gives a value to, or its table's head; "" of other lines."""
    match = _BEGIN.match(line)
    return "" if match is None else match[1] or match[2]


def _help(text: str, fault: ValueError) -> str:
    """What to write where the line at fault holds a number such as 38,4 or 0.4 mm, or signs of a Chinese or
    Japanese keyboard; else nothing."""
    lines, at = text.split("\n"), _AT_LINE.search(str(fault))
    if at is None or int(at[1]) > len(lines):
        return ""
    written = lines[int(at[1]) - 1]
    line = narrow(written)
    if number := _COMMA.search(line):
        return f"; write {number[1]}.{number[2]} with a point"
    if line != written:
        return f"; write {line.strip()}"
    value = _VALUE.search(line)
    return number_help(value[1]) if value else ""


def _deepest_key(text: str) -> int:
    """Parts of the longest dotted key, at least."""
    lines = (s for s in text.split("\n") if not s.lstrip().startswith("#"))
    pieces = (p for line in lines for p in _NO_KEY.split(_STRING.sub("x", line)))
    return max((sum(map(bool, map(str.strip, p.split(".")))) for p in pieces), default=0)
