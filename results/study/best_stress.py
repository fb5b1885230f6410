"""The best design on the wave generator: its stress as a picture, and as a view that turns."""

from __future__ import annotations

import tempfile
from pathlib import Path

from pipeline.study.best import BestField
from results.atomic import write_bytes
from results.renders.ellipse_picture import turning_ellipse, write_ellipse_picture

PICTURE = "best_stress.png"
VIEW = "best_stress"


def write_best_stress(path: Path, best: BestField) -> None:
    """The picture, whole or not at all."""
    with tempfile.TemporaryDirectory(prefix="flexspline-picture-") as folder:
        drawn = Path(folder) / PICTURE
        write_ellipse_picture(drawn, best.field, best.w0_mm)
        write_bytes(path, drawn.read_bytes())


def turning_best(best: BestField) -> dict[str, bytes]:
    """The view by its name in the report."""
    return {VIEW: turning_ellipse(VIEW, best.field, best.w0_mm)}
