"""Pydantic's errors for a file in plain words, on one line."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from flexspline.geometry.errors import MISSING, DesignError
from flexspline.geometry.listed import joined
from flexspline.geometry.near_key import nearest_key
from flexspline.geometry.other_unit import other_unit
from flexspline.geometry.schema import Location, allowed, dotted, keys_of
from flexspline.geometry.shapes import KINDS
from flexspline.geometry.toml_read import number_help
from flexspline.geometry.toml_text import quoted

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails, ValidationError

Refused = TypeVar("Refused", bound=DesignError)
KIND: Location = ("flexspline", "kind")
_NOUNS = {str: "text", bool: "true or false", dict: "a table", list: "a list"}


@dataclass(frozen=True)
class FileWords:
    """Of the keys of one kind of file: how they are called, what they may hold, why one is unknown."""

    name: Callable[[Location], str]
    allowed: Callable[[Location], str]
    unknown: Callable[[Location], str]


def refusal(faults: Iterable[ErrorDetails], words: FileWords, kind: type[Refused]) -> Refused:
    """The first of pydantic's faults in plain words, with the others.

    Unknown keys come first: a misspelt key is also a missing one, and its own name says more.
    """
    ordered = sorted(faults, key=lambda e: e["type"] != "extra_forbidden")
    first, *others = (_refused(fault, words, kind) for fault in ordered)
    return kind(first.key, first.value, first.reason, others)


def _refused(e: ErrorDetails, words: FileWords, kind: type[Refused]) -> Refused:
    location, key = e["loc"], words.name(e["loc"])
    if e["type"] == "extra_forbidden":
        return kind(key, e["input"], words.unknown(location))
    if e["type"] == "missing":
        return kind(key, MISSING, f"give {words.allowed(location)}")
    wrong = f", not {_NOUNS[type(e['input'])]}" if _is_wrong_type(e) else ""
    wrong += number_help(e["input"]) if wrong and isinstance(e["input"], str) else ""
    return kind(key, e["input"], f"must be {words.allowed(location)}{wrong}")


def _is_wrong_type(e: ErrorDetails) -> bool:
    return e["type"].endswith("_type") and type(e["input"]) in _NOUNS


def unknown_key(key: str, known: Sequence[str], table: str) -> str:
    """Why a key is refused that `table` does not have: the known one it is like, or all of them."""
    if (meant := other_unit(key, known)) is not None:
        return f"unknown key; did you mean {meant.key}? {meant.how}"
    near = nearest_key(key, known)
    hint = f"did you mean {near}?" if near else f"{table} takes {', '.join(known)}"
    return f"unknown key; {hint}"


def translate(error: ValidationError, data: Mapping[str, Any]) -> DesignError:
    """What is wrong with the tables of a design file."""
    kind = kind_of(data)
    words = FileWords(dotted, partial(_allowed, kind=kind), partial(_unknown, kind=kind))
    return refusal((_of_a_key(fault, data) for fault in error.errors()), words, DesignError)


def _of_a_key(e: ErrorDetails, data: Mapping[str, Any]) -> ErrorDetails:
    """A fault where the design file has a key: pydantic's of the flexspline's kind is one of its table."""
    if e["type"] not in ("union_tag_invalid", "union_tag_not_found"):
        return {**e, "loc": without_tag(e["loc"])}
    value = data["flexspline"].get("kind", MISSING)
    error_type = "missing" if value is MISSING else "literal_error"
    return {**e, "type": error_type, "loc": KIND, "input": value}


def _allowed(location: Location, kind: str | None) -> str:
    return joined(map(quoted, KINDS), "or") if location == KIND else allowed(location, kind)


def without_tag(location: Location) -> Location:
    """Pydantic puts the chosen kind after ``flexspline``; it is not a key of the file."""
    if location[:1] == ("flexspline",) and location[1:2] in [(kind,) for kind in KINDS]:
        return (location[0], *location[2:])
    return location


def kind_of(data: Mapping[str, Any]) -> str | None:
    """The flexspline's kind, None where none is given."""
    flexspline = data.get("flexspline")
    kind = flexspline.get("kind") if isinstance(flexspline, Mapping) else None
    return kind if kind in KINDS else None


def _unknown(location: Location, kind: str | None) -> str:
    table, key = location[:-1], str(location[-1])
    known = keys_of(table, kind)
    if table == ("flexspline",) and kind:
        others = {other: keys_of(table, other) for other in KINDS if other != kind}
        for other, theirs in others.items():
            if key in theirs:
                of_kind = [k for k in known if k not in theirs]
                return f'belongs to a {other}; kind = "{kind}" takes {", ".join(of_kind)}'
    if not table and key == "design":
        return "is a key of a study file: run `flexspline study` on it"
    return unknown_key(key, known, f"[{dotted(table)}]" if table else "the design")
