"""Letters that no font on this computer has; typst would print an empty box for each.

A PDF carries its fonts. Latin, Greek, Cyrillic, Arabic and Hebrew come with the libraries; Chinese, Japanese
and many more only from fonts of the system.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

STAND_IN = "[U+{:04X}]"
"""A letter's code, by which character tables list it."""
_PLAIN = re.compile(r"[\x00-\u024f\u0370-\u03ff\u0400-\u045f\u2000-\u206f]*")
"""Letters that the fonts of typst and matplotlib have for certain, and those without a shape."""


def font_folder() -> Path:
    """matplotlib's fonts, DejaVu Sans among them."""
    import matplotlib as mpl

    return Path(mpl.get_data_path()) / "fonts" / "ttf"


def charmaps() -> Iterator[frozenset[int]]:
    """Codes that each font has; matplotlib's first, as those of the system take time to read."""
    yield _codes(str(font_folder() / "DejaVuSans.ttf"), 0)
    from typst import Fonts

    for font in Fonts(include_embedded_fonts=False).fonts():
        if font.path:
            yield _codes(str(font.path), font.index)


def printable(
    value: Any, fonts: Callable[[], Iterable[frozenset[int]]] = charmaps
) -> tuple[Any, int]:
    """JSON values with its code for each letter that cannot be printed, and how many there were.

    A letter counts once however often it occurs. `fonts`: codes that each font has; asked only where there
    are letters that need it.
    """
    missing = {c for text in _strings(value) for c in _uncertain(text)}
    if missing:
        for codes in fonts():
            missing -= {c for c in missing if ord(c) in codes}
            if not missing:
                break
    table = str.maketrans({c: STAND_IN.format(ord(c)) for c in missing})
    return (_replaced(value, table) if missing else value), len(missing)


def notice(count: int) -> dict[str, Any]:
    """The block that says so, as `payload_of` has it."""
    letters = "A letter" if count == 1 else f"{count} different letters"
    text = (
        f"{letters} in names or notes cannot be printed, because no font on this computer has "
        f"{'it' if count == 1 else 'them'}; the code is printed instead. report.html and the files contain "
        f"{'the letter' if count == 1 else 'the letters'}."
    )
    spans = [{"style": "", "text": text, "target": ""}]
    return {"kind": "callout", "tone": "amber", "heading": "", "text": spans, "items": []}


def _uncertain(text: str) -> set[str]:
    """Letters that some computer's fonts may lack."""
    if _PLAIN.fullmatch(text):
        return set()
    return {c for c in text if not _PLAIN.fullmatch(c) and _has_shape(c)}


def _has_shape(letter: str) -> bool:
    return unicodedata.category(letter)[0] not in "CZ" and unicodedata.category(letter) != "Mn"


@cache
def _codes(path: str, face: int) -> frozenset[int]:
    from matplotlib.ft2font import FT2Font

    try:
        font = FT2Font(path, face_index=face) if face else FT2Font(path)
        return frozenset(font.get_charmap())
    except (OSError, RuntimeError, TypeError):
        return frozenset()  # a bitmap font, say, which typst does not use either


def _strings(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for v in value.values():
            yield from _strings(v)
    elif isinstance(value, list | tuple):
        for v in value:
            yield from _strings(v)


def _replaced(value: Any, table: dict[int, str]) -> Any:
    if isinstance(value, str):
        return value.translate(table)
    if isinstance(value, dict):
        return {k: _replaced(v, table) for k, v in value.items()}
    return [_replaced(v, table) for v in value] if isinstance(value, list | tuple) else value
