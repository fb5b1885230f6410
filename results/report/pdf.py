"""Sets a document with typst: one fixed template, the content beside it as data."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path

from flexspline.geometry.errors import ComputationError, readable
from flexspline.pipeline.temporary_files import scratch_folder
from flexspline.results.report.document import Document
from flexspline.results.report.missing_letters import font_folder, notice, printable
from flexspline.results.report.payload import payload_of
from flexspline.results.style import REPORT_COLOURS

TEMPLATE = "document.typ"


class ReportError(ComputationError):
    """The report could not be set; carries typst's message."""


def pdf_of(document: Document, pictures: Mapping[str, Path]) -> bytes:
    """The PDF's bytes; `pictures` are PNG files by the names that the document's figures have.

    Words reach typst as strings in a JSON value, never as source: markup or calls in them print as
    their letters. Letters that no font has are replaced, and the first block says so.

    Raises
    ------
    ReportError : typst refused the document. OSError : the folder for temporary files is full.
    """
    import typst

    with scratch_folder("flexspline-report-") as root:
        (root / TEMPLATE).write_bytes(
            files("flexspline.results.report").joinpath(TEMPLATE).read_bytes()
        )
        for name, source in pictures.items():
            shutil.copyfile(source, root / f"{name}.png")
        for i, attachment in enumerate(document.attached):
            (root / f"attached-{i}").write_bytes(attachment.data)
        attached = [{"name": a.safe_name, "about": a.about} for a in document.attached]
        payload, lacking = printable(payload_of(document))
        if lacking:
            payload["blocks"].insert(0, notice(lacking))
        title = f"{document.running}: {document.name}"  # nothing draws it: its letters stay
        report = json.dumps(payload | {"attached": attached, "about": title}, ensure_ascii=False)
        try:
            return typst.compile(
                str(root / TEMPLATE),
                root=str(root),
                sys_inputs={"report": readable(report), "colours": json.dumps(REPORT_COLOURS)},
                font_paths=[str(font_folder())],
                timestamp=0,  # else the same content would give another file each time
            )
        except typst.TypstError as error:
            raise ReportError(f"typst could not set the report: {error}") from error
