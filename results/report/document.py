"""A report as data: blocks of finished words, set by one typst and one HTML template alike (`payload.py`).

Words of the program and of the user are both plain strings inside spans; no template evaluates them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

from flexspline.results.report.attached import Attachment
from flexspline.results.report.spans import Text

FormulaNode = Sequence[Any]
"""Of a formula: ("symbol", letter), ("text", letters), ("over", above, below) of lists of nodes."""


@dataclass(frozen=True)
class Heading:
    """Opens a section; `target` is what a reference names."""

    text: str
    target: str = ""


@dataclass(frozen=True)
class Paragraph:
    """Running words; `small` for remarks below a table."""

    text: Text
    small: bool = False


@dataclass(frozen=True)
class Callout:
    """A box that is read first: a heading, words, a list; amber asks for care."""

    tone: Literal["blue", "amber"]
    heading: str = ""
    text: Text = ()
    items: tuple[Text, ...] = ()


@dataclass(frozen=True)
class Tile:
    """One figure to be seen from afar."""

    label: str
    value: str
    unit: str
    below: str


@dataclass(frozen=True)
class Tiles:
    """Tiles side by side."""

    tiles: tuple[Tile, ...]


@dataclass(frozen=True)
class Facts:
    """Names and values, without a header."""

    rows: tuple[tuple[str, Text], ...]


@dataclass(frozen=True)
class Column:
    """Of a table; `grow` is its share of what width is left, 0 takes what its words need."""

    head: Text
    align: Literal["left", "right"] = "left"
    grow: float = 0.0


@dataclass(frozen=True)
class Table:
    """Rows under a header; with a caption it is numbered. `strong`: index of a row in bold."""

    columns: tuple[Column, ...]
    rows: tuple[tuple[Text, ...], ...]
    caption: Text = ()
    target: str = ""
    strong: int = -1


@dataclass(frozen=True)
class Formula:
    """A displayed formula."""

    nodes: tuple[FormulaNode, ...]
    spoken: str
    """The same in words, for screen readers."""


@dataclass(frozen=True)
class Picture:
    """A numbered figure; `width_pct` of the page's text in print; `view` turns it in the browser.
    A dark page inverts it; one with a view, whose colours mean stress, it dims.
    """

    name: str
    caption: Text
    width_pct: float = 100.0
    view: str = ""


@dataclass(frozen=True)
class Pictures:
    """Figures side by side."""

    figures: tuple[Picture, ...]


@dataclass(frozen=True)
class Bullets:
    """A list."""

    items: tuple[Text, ...]
    small: bool = False


@dataclass(frozen=True)
class File:
    """A file that the report carries, by its name, with a word on what it is."""

    name: str
    about: str
    size: str
    digest: str


@dataclass(frozen=True)
class Files:
    """What is attached, and how the files are known."""

    files: tuple[File, ...]


@dataclass(frozen=True)
class Break:
    """A new page in print, where more than half of the present one is taken."""


Block = (
    Heading
    | Paragraph
    | Callout
    | Tiles
    | Facts
    | Table
    | Formula
    | Pictures
    | Bullets
    | Files
    | Break
)


@dataclass(frozen=True)
class Document:
    """A report.

    Attributes
    ----------
    title : what kind of report it is; `running` the same, short, for the head of each page.
    name : of the design, the user's own letters; `heading` where more than it stands below the title.
    issued : version of the program, and a date where one is wanted.
    numbered : whether sections carry numbers.
    attached : files that the report carries; they are listed at its end.
    """

    title: str
    running: str
    name: str
    issued: str
    blocks: tuple[Block, ...]
    heading: str = ""
    numbered: bool = False
    attached: tuple[Attachment, ...] = ()
