"""Studies for tests: a file's tables as text, workers that are threads of this process, quick evaluations.

Databases that they make in this process do not wait for the disk: a third of the time of a quick study.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

from example_files import EXAMPLES
from sqlalchemy import Engine, event

from flexspline.pipeline.study.cluster import WorkerPool
from flexspline.pipeline.study.evaluate import Outcome, Task
from flexspline.pipeline.study.figures import USUAL_FIGURES
from flexspline.pipeline.study.load import study_from
from flexspline.pipeline.study.study import Study

WALL, LENGTH = "flexspline.wall_thickness_mm", "flexspline.length_mm"

TWO_WALLS = f"""
design = "xb1-40.toml"
[vary]
"{WALL}" = {{ values = [0.38, 0.42] }}
[objective]
"K_b_Nm_per_rad" = "maximize"
[run]
method = "grid"
"""
GRID = f"""
design = "xb1-40.toml"
[vary]
"{WALL}" = {{ min = 0.3, max = 0.5, steps = 3 }}
"{LENGTH}" = {{ values = [25.0, 30.0] }}
[objective]
"K_b_Nm_per_rad" = "maximize"
[run]
method = "grid"
"""


@event.listens_for(Engine, "connect")
def leave_it_to_the_system(connection: Any, _: object) -> None:
    connection.execute("PRAGMA synchronous = OFF")


def study_of(text: str, name: str = "test") -> Study:
    return study_from(tomllib.loads(text), EXAMPLES, name)


@contextmanager
def threads(count: int = 1) -> Iterator[WorkerPool]:
    with ThreadPoolExecutor(count) as executor:
        yield WorkerPool(executor, lambda: count)


def quick(task: Task) -> Outcome:
    """The usual figures without FE: K_b = 1000 · wall + length, peak and backlash the same for all."""
    wall, length = task.values.get(WALL, 0.4), task.values.get(LENGTH, 30.0)
    figures = dict.fromkeys(USUAL_FIGURES, 100.0)
    return Outcome(figures | {"K_b_Nm_per_rad": 1e3 * wall + length})
