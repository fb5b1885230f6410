"""A report as data: blocks of finished words, set by one typst and one HTML template alike.

Words of the program and of the user are both plain strings inside spans; no template evaluates
them. Section, table and figure numbers are counted here, so that both print the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, fields, is_dataclass
from typing import Any, Literal

from flexspline.results.report.attached import Attachment
from flexspline.results.report.spans import Span, Text, words

Node = Sequence[Any]
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

    nodes: tuple[Node, ...]
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

    def payload(self) -> dict[str, Any]:
        """JSON values, numbers and references filled in; what both templates set.

        Raises
        ------
        KeyError : a reference names no section or table.
        """
        blocks = [_encoded(b) for b in (*self.blocks, *_listed(self.attached))]
        _give_numbers(blocks, self.numbered)
        names = {b["target"]: b["number_words"] for b in blocks if b.get("target")}
        _fill_references(blocks, names)
        return {
            "title": self.title,
            "running": self.running,
            "name": self.name,
            "heading": self.heading or self.name,
            "issued": self.issued,
            "blocks": blocks,
        }


def _listed(attached: Sequence[Attachment]) -> Iterable[Block]:
    if attached:
        yield Heading("Files in this report")
        yield Files(tuple(File(a.safe_name, a.about, a.size, a.sha256) for a in attached))


def _encoded(block: Any) -> dict[str, Any]:
    """A block's or span's fields; where a `Text` may stand, always a list of spans."""
    found: dict[str, Any] = {"kind": type(block).__name__.lower()}
    for f in fields(block):
        value = getattr(block, f.name)
        found[f.name] = _texts(value) if "Text" in str(f.type) else _values(value)
    return found


def _texts(value: Any) -> Any:
    if isinstance(value, str) or not value or isinstance(value[0], Span):
        return [asdict(s) for s in words(value)]
    return [_texts(v) for v in value]


def _values(value: Any) -> Any:
    if isinstance(value, tuple | list):
        return [_values(v) for v in value]
    return _encoded(value) if is_dataclass(value) else value


def _give_numbers(blocks: Iterable[dict[str, Any]], numbered: bool) -> None:
    section = table = figure = 0
    for b in blocks:
        if b["kind"] == "heading":
            section += 1
            b["number"] = str(section) if numbered else ""
            b["number_words"] = f"section {section}" if numbered else f"“{b['text']}”"
        elif b["kind"] == "table":
            table += bool(b["caption"])
            b["number_words"] = f"Table {table}" if b["caption"] else ""
        elif b["kind"] == "pictures":
            for picture in b["figures"]:
                figure += 1
                picture["number_words"] = f"Figure {figure}"
                picture["alt"] = _first_sentence(picture["caption"])


def _first_sentence(caption: Sequence[dict[str, Any]]) -> str:
    """What a picture shows, for those who do not see it."""
    return "".join(s["text"] for s in caption).partition(". ")[0].rstrip(".").replace("_", " ")


def _fill_references(value: Any, names: dict[str, str]) -> None:
    if isinstance(value, dict):
        if value.get("style") == "ref":
            value["text"] = names[value["target"]]
        for v in value.values():
            _fill_references(v, names)
    elif isinstance(value, list):
        for v in value:
            _fill_references(v, names)
