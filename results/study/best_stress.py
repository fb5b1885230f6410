"""The best design on the wave generator: its stress as a picture and as a 3-D view."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from flexspline.pipeline.study.best import BestField
from flexspline.results.atomic import write_bytes
from flexspline.results.file_names import BEST_STRESS
from flexspline.results.renders.ellipse_picture import write_ellipse_picture, write_turning_ellipse
from flexspline.results.renders.process import DrawingProcess, NotDrawnError

VIEW = "best_stress"


@dataclass(frozen=True)
class BestStress:
    """What was drawn; `missing` says in one line why something was not, "" if all was.

    `peak_MPa`: of what is drawn, as `flexspline run` finds it; the study's own model may find another.
    """

    picture: Path | None = None
    view: bytes | None = None
    missing: str = ""
    peak_MPa: float | None = None

    @property
    def views(self) -> dict[str, bytes]:
        """The view by its name in the report."""
        return {VIEW: self.view} if self.view is not None else {}


NOTHING_DRAWN = BestStress()


def draw_best_stress(folder: Path, best: BestField | None) -> BestStress:
    """Draw both in a process of their own, the picture into `folder`, whole or not at all.

    A picture that an earlier run left and that cannot be drawn now is removed.
    """
    if best is None:
        return NOTHING_DRAWN
    path = folder / BEST_STRESS
    picture: Path | None = None
    with DrawingProcess() as process:
        try:
            write_bytes(path, process.draw(write_ellipse_picture, best.field, best.w0_mm))
            picture = path
            view = process.draw(write_turning_ellipse, best.field, best.w0_mm)
            return BestStress(path, view, peak_MPa=best.field.peak.mises_MPa)
        except NotDrawnError as error:
            if picture is None:
                path.unlink(missing_ok=True)
            return BestStress(picture, None, str(error), best.field.peak.mises_MPa)
