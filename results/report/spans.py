"""Text of a report as spans: letters and their style, without template code."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from flexspline.pipeline.stiffnesses import FIGURES
from flexspline.results.quantities import quantity

NBSP = "\N{NO-BREAK SPACE}"
"""Between a number and its unit: no line ends there."""
Style = Literal["", "bold", "symbol", "note", "code", "break", "ref", "alarm"]


@dataclass(frozen=True)
class Span:
    """A piece of text. `target`: the id of the section or table that a "ref" points at."""

    style: Style
    text: str
    target: str = ""


Words = tuple[Span, ...]
Text = str | Words
"""A bare string is plain letters."""


def plain(text: str) -> Words:
    """Letters as they are."""
    return (Span("", text),)


def bold(text: str) -> Words:
    """Words that stand out."""
    return (Span("bold", text),)


def symbol(text: str) -> Words:
    """A quantity's letter with its index after "_", as `results.quantities` has them."""
    return (Span("symbol", text),)


def alarm(text: str) -> Words:
    """A word that must not be missed."""
    return (Span("alarm", text),)


def code(text: str) -> Words:
    """What is typed."""
    return (Span("code", text),)


def note(text: Text) -> Words:
    """Small words on a line of their own, below what stands before."""
    return (Span("break", ""), *(Span(s.style or "note", s.text, s.target) for s in words(text)))


def ref(target: str) -> Words:
    """The number of a section or table, as a link to it."""
    return (Span("ref", "", target),)


_NAMES = ("T_L", *(quantity(f"{figure}_Nm_per_rad").symbol for figure in FIGURES))
_SYMBOLS = re.compile(rf"({'|'.join(map(re.escape, sorted(_NAMES, reverse=True)))})(?!\w)")
"""Longer ones first; not the beginning of a key, as of K_b_Nm_per_rad."""


def worded(text: str) -> Words:
    """The program's own words, in which T_L and the stiffnesses, as K_b,lobes, are symbols."""
    spans, at = [], 0
    for match in _SYMBOLS.finditer(text):
        spans += [Span("", text[at : match.start()]), Span("symbol", match.group())]
        at = match.end()
    return tuple(s for s in (*spans, Span("", text[at:])) if s.text)


def words(text: Text) -> Words:
    """A bare string as spans."""
    return plain(text) if isinstance(text, str) else text
