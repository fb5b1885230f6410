"""report.pdf of a run from its content."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from flexspline.results.atomic import write_bytes
from flexspline.results.report.content import ReportContent
from flexspline.results.report.payload import payload_of
from flexspline.results.report.pdf import ReportError, pdf_of
from flexspline.results.report.sections import run_document

__all__ = ["ReportError", "payload", "write_report"]


def write_report(path: Path, content: ReportContent) -> None:
    """Write the PDF, whole or not at all.

    Raises
    ------
    ReportError : typst refused the document.
    """
    write_bytes(path, pdf_of(run_document(content), content.pictures))


def payload(content: ReportContent) -> dict[str, Any]:
    """The content as JSON values: finished text in the order in which the templates set it."""
    return payload_of(run_document(content))
