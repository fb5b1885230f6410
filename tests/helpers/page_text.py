"""What a person reads in a PDF or a page, and what a report's payload says: letters, to compare."""

import re
from html.parser import HTMLParser

from pypdf import PdfReader

_LAYOUT = re.compile(r"[\s\u200b\u00ad\u2010-]")
"""Spaces, break points and hyphens: typesetting may add or move them."""


_FOOT = re.compile(r"Page \d+ of \d+$")


def letters(text):
    return _LAYOUT.sub("", text)


def pdf_letters(path):
    """All pages; the head that they share stands once, and one foot: a paragraph may go on behind them."""
    pages = [page.extract_text().splitlines() for page in PdfReader(path).pages]
    head = 0
    while len(pages) > 1 and len({tuple(lines[: head + 1]) for lines in pages}) == 1:
        head += 1
    body = [lines[head:] for lines in pages]
    inside = [lines[:-1] if _FOOT.search(lines[-1]) else lines for lines in body[:-1]]
    every = [pages[0][:head], *inside, body[-1]]
    return letters(" ".join(line for lines in every for line in lines))


class _Reader(HTMLParser):
    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.said, self.tags, self.attributes, self._mute = [], [], [], 0

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += [(tag, name, value or "") for name, value in attrs]
        self._mute += tag in ("script", "style", "title")

    def handle_endtag(self, tag):
        self._mute -= tag in ("script", "style", "title")

    def handle_data(self, data):
        if not self._mute:
            self.said.append(data)


def read_page(html):
    """Letters that a page shows, its tags in order, and (tag, attribute, value) of all of them."""
    reader = _Reader()
    reader.feed(html)
    reader.close()
    return letters("".join(reader.said)), reader.tags, reader.attributes


def spans(value):
    """Every span of a payload."""
    if isinstance(value, dict):
        if set(value) == {"style", "text", "target"}:
            yield value
        for v in value.values():
            yield from spans(v)
    elif isinstance(value, list):
        for v in value:
            yield from spans(v)


def strings(value):
    """Every text of a payload that a reader should see; symbols apart, they are set as formulas."""
    keys = {"title", "running", "name", "heading", "issued", "label", "value", "unit", "below",
            "number_words"}  # fmt: skip
    if isinstance(value, dict):
        if value.get("style") == "symbol":
            return
        # "section 2" is said where something refers to it; a picture's name is its file's
        silent = {"heading": "number_words", "picture": "name"}.get(value.get("kind"))
        for k, v in value.items():
            if k == silent:
                continue
            if isinstance(v, str) and (k in keys or k == "text"):
                yield v
            else:
                yield from strings(v)
    elif isinstance(value, list):
        for v in value:
            yield from strings(v)
