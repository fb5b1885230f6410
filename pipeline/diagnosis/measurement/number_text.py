"""Numbers as programs of several countries write them: decimal point or comma, grouped thousands."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Literal

import numpy as np

DecimalMark = Literal[".", ","]
OTHER: dict[DecimalMark, DecimalMark] = {".": ",", ",": "."}
_GROUPS = " \u00a0\u202f\u2009'’"
"""Spaces and apostrophes between thousands: never a decimal mark."""
_MINUS = str.maketrans({"−": "-", "–": "-"})
_EXPONENT = r"(?:[eE][+-]?\d+)?"
_FLOAT = re.compile(rf"[+-]?(?:\d+\.?\d*|\.\d+){_EXPONENT}", re.ASCII)
_CLEAN = re.compile(r"[0-9+\-.eE\n]*")
_GROUPED = {
    mark: re.compile(
        rf"[+-]?\d{{1,3}}([{_GROUPS}{OTHER[mark]}])\d{{3}}(?:\1\d{{3}})*(?:\{mark}\d*)?", re.ASCII
    )
    for mark in OTHER
}  # fmt: skip
_DECIMAL = {
    mark: re.compile(
        # not three digits after one to three others, the first no 0: that may be a thousand
        rf"(?<![\d.,])(?:(?:0\d*|\d{{4,}})?\{mark}\d|\d{{1,3}}\{mark}(?:\d{{1,2}}|\d{{4,}})?(?![\d.,]))"
        rf"|\d{re.escape(OTHER[mark])}\d{{3}}\{mark}\d|\d\{mark}\d{{3}}[eE]",
        re.ASCII,
    )
    for mark in OTHER
}  # fmt: skip
"""What only a decimal mark can be."""


@dataclass(frozen=True)
class MarkEvidence:
    """First text (n-th of its column) that only the decimal point, or only the comma, explains."""

    point: int | None
    comma: int | None
    either: int | None
    """First text that is a decimal with one mark and a thousand with the other."""


def evidence_of(texts: Sequence[str]) -> MarkEvidence:
    """Which decimal marks a column shows."""
    whole = "\n".join(texts)

    def first(mark: DecimalMark) -> int | None:
        match = _DECIMAL[mark].search(whole) if mark in whole else None
        return None if match is None else whole.count("\n", 0, match.end())

    marked = re.search(r"[.,]", whole)
    either = None if marked is None else whole.count("\n", 0, marked.start())
    return MarkEvidence(first("."), first(","), either)


def numbers_of(texts: Sequence[str], mark: DecimalMark) -> tuple[np.ndarray, int | None]:
    """Values (n,), and the first text that is no finite number (None: all are)."""
    whole = "\n".join(texts)
    if mark == "," and "." not in whole:
        whole = whole.replace(",", ".")
    if _CLEAN.fullmatch(whole):
        try:
            numbers = np.array([float(t) for t in whole.split("\n")])
            if np.isfinite(numbers).all():
                return numbers, None
        except ValueError:
            pass
    values = np.empty(len(texts))
    for i, text in enumerate(texts):
        value = number_of(text, mark)
        if value is None:
            return values[:i], i
        values[i] = value
    return values, None


def number_of(text: str, mark: DecimalMark) -> float | None:
    """The finite number that a text is, None for none."""
    plain = text.translate(_MINUS)
    grouped = _GROUPED[mark].fullmatch(plain)
    if grouped is not None:
        plain = plain.replace(grouped[1], "")
    elif OTHER[mark] in plain:
        return None
    plain = plain.replace(mark, ".")
    if _FLOAT.fullmatch(plain) is None:
        return None
    value = float(plain)
    return value if isfinite(value) else None
