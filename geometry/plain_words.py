"""What pydantic found wrong with a design, said in plain words on one line."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from flexspline.geometry.errors import MISSING, DesignError
from flexspline.geometry.near_key import nearest_key
from flexspline.geometry.schema import Location, allowed, dotted, keys_of
from flexspline.geometry.shapes import KINDS
from flexspline.geometry.toml_read import number_help

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails, ValidationError

_NOUNS = {str: "text", bool: "true or false", dict: "a table", list: "a list"}


def translate(error: ValidationError, data: Mapping[str, Any]) -> DesignError:
    """The first fault as a DesignError with the others.

    Unknown keys come first: a misspelt key is also a missing one, and its own name says more.
    """
    found = sorted(error.errors(), key=lambda e: e["type"] != "extra_forbidden")
    first, *others = (_translated(each, data) for each in found)
    return DesignError(first.key, first.value, first.reason, others)


def _translated(e: ErrorDetails, data: Mapping[str, Any]) -> DesignError:
    kind = kind_of(data)
    location = without_tag(e["loc"])
    if e["type"] == "extra_forbidden":
        return DesignError(dotted(location), e["input"], _unknown(location, kind))
    if e["type"] in ("union_tag_invalid", "union_tag_not_found"):
        location = (*location, "kind")
        value = data["flexspline"].get("kind", MISSING)
        verb = "give" if value is MISSING else "must be"
        return DesignError(dotted(location), value, f"{verb} {_or(KINDS)}")
    if e["type"] == "missing":
        return DesignError(dotted(location), MISSING, f"give {allowed(location, kind)}")
    wrong = f", not {_NOUNS[type(e['input'])]}" if _is_wrong_type(e) else ""
    wrong += number_help(e["input"]) if wrong and isinstance(e["input"], str) else ""
    return DesignError(dotted(location), e["input"], f"must be {allowed(location, kind)}{wrong}")


def _is_wrong_type(e: ErrorDetails) -> bool:
    return e["type"].endswith("_type") and type(e["input"]) in _NOUNS


def without_tag(location: Location) -> Location:
    """Pydantic puts the chosen kind after ``flexspline``; it is no key of the file."""
    if location[:1] == ("flexspline",) and location[1:2] in [(kind,) for kind in KINDS]:
        return (location[0], *location[2:])
    return location


def kind_of(data: Mapping[str, Any]) -> str | None:
    """The flexspline's kind, None where none is given."""
    flexspline = data.get("flexspline")
    kind = flexspline.get("kind") if isinstance(flexspline, Mapping) else None
    return kind if kind in KINDS else None


def _or(words: Iterable[str]) -> str:
    return " or ".join(f'"{word}"' for word in words)


def _unknown(location: Location, kind: str | None) -> str:
    table, key = location[:-1], str(location[-1])
    known = keys_of(table, kind)
    if table == ("flexspline",) and kind:
        others = {other: keys_of(table, other) for other in KINDS if other != kind}
        for other, theirs in others.items():
            if key in theirs:
                own = [k for k in known if k not in theirs]
                return f'belongs to a {other}; kind = "{kind}" takes {", ".join(own)}'
    if not table and key == "design":
        return "names a design: the file is a study, which `flexspline study` takes"
    if near := nearest_key(key, known):
        return f"unknown key; did you mean {near}?"
    where = f"[{dotted(table)}]" if table else "the design"
    return f"unknown key; {where} takes {', '.join(known)}"
