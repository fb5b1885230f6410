"""A line on stderr while a study runs: how far, how fast, best so far, time left."""

from __future__ import annotations

import sys
import time
from contextlib import suppress
from dataclasses import dataclass, field

from flexspline.pipeline.study.drive import StudyProgress
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.study import Study
from flexspline.results.study.labels import valued

EVERY_S = 5.0
"""Between two lines where stderr is no terminal; on one the line is renewed in place."""


@dataclass
class Watch:
    """Prints progress, not more often than is readable."""

    study: Study
    last: float = field(default=-1e9)
    ended: bool = False

    def __call__(self, progress: StudyProgress) -> None:
        finished = len(progress.rows) >= progress.size
        terminal = sys.stderr.isatty()
        early = time.monotonic() - self.last < (0 if terminal else EVERY_S)
        if self.ended or (early and not finished):
            return
        self.last, self.ended = time.monotonic(), finished
        text = line(self.study, progress)
        end = "\n" if finished or not terminal else ""
        start = "\r\x1b[K" if terminal else ""
        with suppress(OSError):  # the reader has gone: no reason to stop
            print(f"{start}{text}", end=end, file=sys.stderr, flush=True)


def line(study: Study, progress: StudyProgress) -> str:
    """One line of progress."""
    done, size = len(progress.rows), progress.size
    rate = progress.fresh / progress.seconds if progress.seconds > 0 else 0.0
    parts = [f"{done} of {size} designs", f"{rate:.2f} per s"]
    failed = sum(not study.is_answered(r.outcome.figures) for r in progress.rows)
    if failed:
        parts.append(f"{failed} cannot be built or solved")
    so_far = StudyResult(study, tuple(progress.rows))
    best = () if so_far.about_scatter else so_far.pareto
    for i, key in enumerate(study.file.objective if best else ()):
        row = min(best, key=lambda r: so_far.costs(r)[i])
        parts.append(f"best {valued(key, row.outcome.figures)}")
    if rate > 0 and done < size:
        parts.append(f"{(size - done) / rate:.0f} s left")
    return " · ".join(parts)
