"""Sets the report with typst: one fixed template, the content beside it as data."""

from __future__ import annotations

import json
import shutil
import tempfile
from dataclasses import fields
from importlib.resources import files
from pathlib import Path
from typing import Any

from geometry.errors import ComputationError
from results.atomic import write_bytes
from results.report import limits, tables
from results.report.content import ReportContent

TEMPLATE = "report.typ"
ROOMY = 1200
"""Letters of free text (names, warnings, stages) up to which sections begin on new pages: beyond,
they follow each other and the report stays within six pages."""


class ReportError(ComputationError):
    """The report could not be set; carries typst's message."""


def write_report(path: Path, content: ReportContent) -> None:
    """Write the PDF, whole or not at all.

    Names from the design file reach typst as strings in a JSON value, never as source: markup or
    calls in them print as their letters.

    Raises
    ------
    ReportError : typst refused the document.
    """
    import typst

    with tempfile.TemporaryDirectory() as scratch:
        root = Path(scratch)
        template = files("results.report").joinpath(TEMPLATE).read_bytes()
        (root / TEMPLATE).write_bytes(template)
        data = payload(content) | {"pictures": _copied(content, root)}
        try:
            pdf = typst.compile(
                str(root / TEMPLATE),
                root=str(root),
                sys_inputs={"report": json.dumps(data)},
                timestamp=0,  # else the same content would give another file each time
            )
        except typst.TypstError as error:
            raise ReportError(f"typst could not set the report: {error}") from error
    write_bytes(path, pdf)


def payload(content: ReportContent) -> dict[str, Any]:
    """The content as JSON values: finished text in the order in which the template sets it."""
    design = content.design
    names = [design.name, design.material.flexspline.name, design.shaft_material.name]
    free = [*names, *content.warnings, *(content.stage_seconds or {})]
    return {
        "roomy": sum(map(len, free)) <= ROOMY,
        "name": design.name,
        "version": content.version,
        "issued": content.issued,
        "torque": f"{design.load.torque_Nm:g}",
        "facts": tables.design_facts(design),
        "answers": tables.answers(content),
        "budget": tables.budget(content),
        "solves": tables.solves(content),
        "fatigue": limits.fatigue(content),
        "assumptions": limits.assumptions(content),
        "extended": content.extended_model,
        "warnings": list(content.warnings),
        "stages": [[name, f"{s:.1f}"] for name, s in (content.stage_seconds or {}).items()],
        "elapsed": f"{sum((content.stage_seconds or {}).values()):.1f}",
        "tolerance": f"{design.solver.tolerance_pct:g}",
        "versions": [list(pair) for pair in (content.versions or {}).items()],
    }


def _copied(content: ReportContent, root: Path) -> dict[str, bool]:
    """Copy the pictures under their fixed names; which of them there are."""
    given = {f.name: getattr(content.pictures, f.name) for f in fields(content.pictures)}
    for name, source in given.items():
        if source is not None:
            shutil.copyfile(source, root / f"{name}.png")
    return {name: source is not None for name, source in given.items()}
