"""A document in both its forms."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from flexspline.results.report.document import Document
from flexspline.results.report.page import page_of, png
from flexspline.results.report.pdf import pdf_of

PDF, HTML = "report.pdf", "report.html"


def reports_of(
    document: Document, pictures: Mapping[str, Path], views: Mapping[str, bytes] | None = None
) -> dict[str, bytes]:
    """Bytes of report.pdf and report.html by file name; the pictures, PNG files, as they are.

    `views` turn in the browser (`results.renders.turntable`), by the names that the figures give.

    Raises
    ------
    ReportError : typst refused the document.
    """
    return {
        PDF: pdf_of(document, pictures),
        HTML: page_of(document, {name: png(path) for name, path in pictures.items()}, views),
    }
