"""Reads a column's heading: the quantity, and its unit if one is written."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from flexspline.geometry.full_width import narrow
from flexspline.pipeline.diagnosis.measurement.time_form import without_form
from flexspline.pipeline.diagnosis.measurement.units import QUANTITIES, UNITS, unit_named
from flexspline.pipeline.diagnosis.measurement.vocabulary import (
    ANOTHER,
    EASTERN,
    EASTERN_WORDS,
    ENDINGS,
    INPUT,
    MINUS,
    OTHER_TIMES,
    PLUS,
    QUANTITY_OF,
    SAYS_NOTHING,
    STD_WORDS,
    SYMBOLS,
)

LABELS = ("unit", "specimen", "part")
PLAIN = ("cycle",)
DESIGN_KEY = re.compile(r"[a-z]\w*(?:\[\d+\])?(?:\.\w+(?:\[\d+\])?)+", re.ASCII)

_TOKEN = re.compile(r"[^\W\d_]+|\d+|(?<![^\s(\[_])[+\-−](?![^\s)\]_])|\+")
"""Words, numbers, and signs that stand alone; a hyphen inside a word is not such a sign."""
_BRACKETS = re.compile(r"\[([^\]]*)\]|\(([^)]*)\)|<([^>]*)>|\{([^}]*)\}")
_SCALE = re.compile(r"[*×÷/=]\s*\d|\d[.,]\d|\d\s*[*×÷/=]|^\s*[-−–]")
"""A factor beside the quantity, or a sign before it: the readings are then not in the unit beside it."""
_HALF = re.compile(r"^[^\[({<]*[\])}>]")
"""The end of a bracket that began before."""
_PARTED = re.compile(r"\s*/\s*|\s+in\s+|\s*[,;:_]\s*|\s+|-")
"""What may stand between words and unit."""


@dataclass(frozen=True)
class ColumnName:
    """What the head of a column says.

    Attributes
    ----------
    quantity : of `QUANTITIES`, or "cycle", a label, or a dotted design key.
    unit : our word for the unit, None where the head says none. strange : what stands in its place.
    ours : written as docs/contract.md writes it. sure : no word is left that may say something else.
    """

    quantity: str
    unit: str | None = None
    strange: str | None = None
    ours: bool = False
    sure: bool = True


def column_name(head: str) -> ColumnName | None:
    """What a head says; None where it is no quantity of ours."""
    text = without_form(narrow(head)).strip()
    if text in LABELS or text in PLAIN or DESIGN_KEY.fullmatch(text):
        return ColumnName(text, ours=True)
    for quantity in sorted(QUANTITIES, key=len, reverse=True):
        suffix = text.removeprefix(quantity)
        if suffix != text and re.fullmatch(r"_[A-Za-z_]+", suffix):
            return _ours(quantity, suffix[1:])
    words, unit = _parted(text)
    return None if _SCALE.search(words) else _in_words(words, unit)


def is_unit(written: str) -> bool:
    """Whether a text is a unit of any quantity, in brackets or without."""
    bare = written.strip().strip("[](){}<>")
    return any(unit_named(name, bare) is not None for name in UNITS)


def _ours(quantity: str, suffix: str) -> ColumnName | None:
    name = QUANTITIES[quantity].name
    if suffix in UNITS[name].values():
        return ColumnName(quantity, suffix, ours=True)
    unit = unit_named(name, suffix)
    if unit is not None:
        return ColumnName(quantity, unit)
    words, unit = _parted(f"{quantity}_{suffix}")
    in_words = _in_words(words, unit)
    one_word = "_" not in suffix and suffix.lower() not in SAYS_NOTHING | ANOTHER | INPUT
    if unit is None and one_word and QUANTITY_OF.get(suffix.lower()) is None:
        return ColumnName(quantity, None, suffix)  # torque_lbf
    return in_words


def _parted(text: str) -> tuple[str, str | None]:
    """Words and unit of a head."""
    square = None
    for match in reversed(list(_BRACKETS.finditer(text))):
        inside = next(g for g in match.groups() if g is not None)
        rest = text[: match.start()] + " " + text[match.end() :]
        if is_unit(inside):
            return rest, inside
        if match[0].startswith("[") and inside.strip():
            square = square or (rest, inside)
    if square is not None:
        return square
    for match in _PARTED.finditer(text):
        rest = text[match.end() :]
        if match.start() and is_unit(rest) and not _HALF.search(rest):
            return text[: match.start()], rest
    return text, None


def _in_words(text: str, written: str | None) -> ColumnName | None:
    kinds: set[str] = set()
    left: list[str] = []
    for token in _tokens(text):
        ending = "" if token in QUANTITY_OF else next(filter(token.endswith, ENDINGS), "")
        if ending:
            kinds.add(ENDINGS[ending])
            rest = token.removesuffix(ending)
            if QUANTITY_OF.get(rest) in PLAIN:  # the time of a cycle is no time stamp
                kinds.add(QUANTITY_OF[rest])
            left.append(rest)
        elif token in QUANTITY_OF:
            kinds.add(QUANTITY_OF[token])
        else:
            left.append(token)
    if kinds & QUANTITIES.keys() and kinds & set(LABELS):
        kinds -= set(LABELS)
        left.append("of a gear")  # "gear temperature": another word, not another quantity
    if not kinds and written is not None:
        kinds, left = _by_symbol(left, written)
    if len(kinds) != 1 or ("part" in kinds and left):
        return None
    return _qualified(kinds.pop(), left, written)


def _tokens(text: str) -> Iterator[str]:
    """Words, figures and signs in small letters; Chinese and Japanese cut into words that are known."""
    for token in (t.lower() for t in _TOKEN.findall(text)):
        if EASTERN.search(token):
            yield from (part for part in EASTERN_WORDS.split(token) if part)
        else:
            yield token


def _by_symbol(words: list[str], written: str) -> tuple[set[str], list[str]]:
    """Quantities for which one of the words is a symbol and the unit is right, and the other words."""
    for word in words:
        fits = {
            q
            for q, letters in SYMBOLS.items()
            if word in letters and unit_named(QUANTITIES[q].name, written) is not None
        }
        if fits:
            return fits, [w for w in words if w != word]
    return set(), words


def _qualified(quantity: str, words: list[str], written: str | None) -> ColumnName | None:
    left = [w for w in words if w and w not in SAYS_NOTHING]
    if quantity == "stiffness" and STD_WORDS & set(left):
        quantity, left = "stiffness_std", [w for w in left if w not in STD_WORDS]
    if (OTHER_TIMES if quantity == "time" else ANOTHER) & set(left):
        return None
    if INPUT & set(left):
        if quantity == "torque":
            return None
        if quantity == "angle":
            quantity, left = "input_angle", [w for w in left if w not in INPUT]
    for name, signs in (("angle_plus", PLUS), ("angle_minus", MINUS)):
        if quantity == "angle" and signs & set(left):
            quantity, left = name, [w for w in left if w not in signs]
    if quantity not in QUANTITIES:
        return ColumnName(quantity, sure=not left)
    unit = None if written is None else unit_named(QUANTITIES[quantity].name, written)
    if unit is None and written is not None and _is_another(written.strip()):
        return None
    strange = written.strip() if written is not None and unit is None else None
    return ColumnName(quantity, unit, strange, sure=not left)


def _is_another(written: str) -> bool:
    """Whether a word that is a unit in small letters only means another quantity: "Torque (Min)"."""
    return written != written.lower() and written.lower() in ANOTHER
