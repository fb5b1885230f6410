"""report.pdf of a run from its content."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

from flexspline.results.atomic import write_bytes
from flexspline.results.report.content import ReportContent
from flexspline.results.report.pdf import ReportError, pdf_of
from flexspline.results.report.sections import run_document

__all__ = ["ReportError", "payload", "pictures_of", "write_report"]


def write_report(path: Path, content: ReportContent) -> None:
    """Write the PDF, whole or not at all.

    Raises
    ------
    ReportError : typst refused the document.
    """
    write_bytes(path, pdf_of(run_document(content), pictures_of(content)))


def payload(content: ReportContent) -> dict[str, Any]:
    """The content as JSON values: finished text in the order in which the templates set it."""
    return run_document(content).payload()


def pictures_of(content: ReportContent) -> dict[str, Path]:
    """The pictures that there are, by the names that the document's figures have."""
    given = {f.name: getattr(content.pictures, f.name) for f in fields(content.pictures)}
    return {name: source for name, source in given.items() if source is not None}
