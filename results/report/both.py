"""A document as PDF and as HTML."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

from flexspline.results.file_names import REPORT
from flexspline.results.report.document import Document
from flexspline.results.report.page import page_of, png
from flexspline.results.report.pdf import pdf_of


def reports_of(
    document: Document,
    pictures: Mapping[str, Path],
    views: Mapping[str, bytes] | None = None,
    name: str = REPORT,
    smaller: Mapping[str, bytes] | None = None,
) -> dict[str, bytes]:
    """Bytes of `name`.pdf and `name`.html by file name, made at once: typst needs no Python.

    The pictures are PNG files; the page carries those as WebP that `smaller` has. `views` turn in the browser
    (`results.renders.turntable`), by the names that the figures give.

    Raises
    ------
    ReportError : typst refused the document.
    """

    def page() -> bytes:
        images = {picture: png(path) for picture, path in pictures.items()}
        for picture, data in (smaller or {}).items():
            if picture in images:
                images[picture] = replace(images[picture], data=data)
        return page_of(document, images, views)

    with ThreadPoolExecutor(1) as beside:
        made = beside.submit(page)
        return {f"{name}.pdf": pdf_of(document, pictures), f"{name}.html": made.result()}
