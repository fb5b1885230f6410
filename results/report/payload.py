"""Data for both report templates: JSON values, with numbers and references filled in.

Section, table and figure numbers are counted here, so that both print the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, fields, is_dataclass
from typing import Any

from flexspline.results.report.attached import Attachment
from flexspline.results.report.document import Block, Document, File, Files, Heading
from flexspline.results.report.spans import Span, words


def payload_of(document: Document) -> dict[str, Any]:
    """The report's words and blocks as JSON values.

    Raises
    ------
    KeyError : a reference names no section or table.
    """
    blocks = [_encoded(b) for b in (*document.blocks, *_listed(document.attached))]
    _give_numbers(blocks, document.numbered)
    names = {b["target"]: b["number_words"] for b in blocks if b.get("target")}
    _fill_references(blocks, names)
    return {
        "title": document.title,
        "running": document.running,
        "name": document.name,
        "heading": document.heading or document.name,
        "issued": document.issued,
        "blocks": blocks,
    }


def _listed(attached: Sequence[Attachment]) -> Iterable[Block]:
    if attached:
        yield Heading("Files in this report")
        yield Files(tuple(File(a.safe_name, a.about, a.size, a.sha256) for a in attached))


def _encoded(block: Any) -> dict[str, Any]:
    """A block's or span's fields; where a `Text` may stand, always a list of spans."""
    encoded: dict[str, Any] = {"kind": type(block).__name__.lower()}
    for f in fields(block):
        value = getattr(block, f.name)
        encoded[f.name] = _texts(value) if "Text" in str(f.type) else _values(value)
    return encoded


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
