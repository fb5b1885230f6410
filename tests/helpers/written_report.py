"""The report of a run by itself: its PDF, and its content as data."""

from pathlib import Path
from typing import Any

from flexspline.results.report.content import ReportContent
from flexspline.results.report.payload import payload_of
from flexspline.results.report.pdf import pdf_of
from flexspline.results.report.sections import run_document


def write_report(path: Path, content: ReportContent) -> None:
    path.write_bytes(pdf_of(run_document(content), content.pictures))


def payload(content: ReportContent) -> dict[str, Any]:
    """Finished text in the order in which the templates set it."""
    return payload_of(run_document(content))
