"""Sets a document as one HTML file: one fixed template, its pictures, views and script inside.

The content enters through jinja2's automatic escaping, or as JSON that it escapes. A policy in the
page allows the script written here, by its SHA-256, and nothing else: no other script, no request.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexspline.geometry.errors import readable
from flexspline.results.page_3d.script import in_function, script_3d
from flexspline.results.report.document import Document
from flexspline.results.report.payload import payload_of
from flexspline.results.style import REPORT_COLOURS, as_css, colour_scale

if TYPE_CHECKING:
    from jinja2 import Environment

TEMPLATE, STYLE, SCRIPT = "page.html", "page.css", "page.js"
WORDS = {
    "turns": "3-D view. Arrow keys turn it, plus and minus zoom, Home resets it.",
    "reset": "Reset view",
    "show": "Show its text",
    "help": "Drag to turn, Shift and drag to move, click and scroll to zoom; or use the arrow keys, "
    "+ and −.",
}
"""What only a page needs to say."""


@dataclass(frozen=True)
class Image:
    """A picture's bytes (PNG or WebP) and its size in pixels."""

    data: bytes
    width: int
    height: int

    @property
    def uri(self) -> str:
        kind = "png" if self.data.startswith(b"\x89PNG") else "webp"
        return f"data:image/{kind};base64,{base64.b64encode(self.data).decode()}"


def png(path: Path) -> Image:
    """A PNG file as it is."""
    data = path.read_bytes()
    return Image(data, *(int.from_bytes(data[i : i + 4], "big") for i in (16, 20)))


def page_of(
    document: Document, pictures: Mapping[str, Image], views: Mapping[str, bytes] | None = None
) -> bytes:
    """The HTML file's bytes, the same for the same content.

    Parameters
    ----------
    pictures : by the names that the document's figures have.
    views : by the names that they have there; what `results.renders.turntable` made. A figure whose
        view is not given shows its picture alone.
    """
    from markupsafe import Markup

    # sorted: they are drawn side by side, and come in the order in which they are ready
    decoded: dict[str, dict[str, Any]] = {
        n: json.loads(v) for n, v in sorted((views or {}).items())
    }
    script, style = _script() if decoded else "", as_css(REPORT_COLOURS) + _file(STYLE)
    shown = {n: {k: v[k] for k in ("camera", "mark")} for n, v in decoded.items()}
    text = (
        _environment()
        .get_template(TEMPLATE)
        .render(
            d=payload_of(document),
            pictures=pictures,
            attached=document.attached,
            views=decoded,
            shown={"scale": colour_scale(), "views": shown},
            script=Markup(script),
            css=Markup(style),
            policy=_policy([script] if decoded else [], style),
            ui=WORDS,
        )
    )
    return readable(text).encode()


def _policy(scripts: Sequence[str], style: str) -> str:
    def allowed(texts: Sequence[str]) -> str:
        hashes = (base64.b64encode(hashlib.sha256(t.encode()).digest()).decode() for t in texts)
        return " ".join(f"'sha256-{h}'" for h in hashes) or "'none'"

    return (
        f"default-src 'none'; script-src {allowed(scripts)}; style-src {allowed([style])}; "
        "img-src data:; base-uri 'none'; form-action 'none'"
    )


@cache
def _script() -> str:
    """What turns the views: three.js and `SCRIPT`, in one."""
    return script_3d() + in_function(SCRIPT, _file(SCRIPT))


def _file(name: str) -> str:
    return files("flexspline.results.report").joinpath(name).read_text(encoding="utf-8")


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    made = Environment(
        autoescape=True, loader=FunctionLoader(_file), trim_blocks=True, undefined=StrictUndefined
    )
    made.tests["greek_capital"] = lambda letter: "Α" <= letter <= "Ω"
    return made
