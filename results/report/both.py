"""A document in both its forms."""

from __future__ import annotations

from collections.abc import Mapping
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
) -> dict[str, bytes]:
    """Bytes of `name`.pdf and `name`.html by file name; the pictures, PNG files, as they are.

    `views` turn in the browser (`results.renders.turntable`), by the names that the figures give.

    Raises
    ------
    ReportError : typst refused the document.
    """
    return {
        f"{name}.pdf": pdf_of(document, pictures),
        f"{name}.html": page_of(document, {n: png(path) for n, path in pictures.items()}, views),
    }
