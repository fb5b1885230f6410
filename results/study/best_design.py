"""The best design of a study as a design file."""

from __future__ import annotations

from pathlib import Path

from flexspline.geometry.template import design_text
from flexspline.pipeline.study.result import StudyResult
from flexspline.results.atomic import write_bytes
from flexspline.results.file_names import BEST_DESIGN


def write_best_design(folder: Path, result: StudyResult) -> Path | None:
    """Write the first of the best designs beside the table; None where no design is better than another."""
    if result.about_scatter or not result.pareto:
        return None
    row = result.pareto[0]
    name = f"{result.study.design.name}, design {row.slot} of {result.study.name}"
    design = result.design_of(row).model_copy(update={"name": name})
    path = folder / BEST_DESIGN
    write_bytes(path, design_text(design).encode())
    return path
