"""Good files of every kind that the program reads, small, and the command that reads each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from example_files import EXAMPLES
from in_process import flexspline

from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.study.cluster import WorkerPool

CUP = EXAMPLES / "xb1-40.toml"
GIVEN = ("--Kb", 31329, "--Ke", 43339)
ROWS = {"xb1-40-sweep": 130, "size-40-end-points": 8, "xb1-40-specimens": 6}
"""Lines kept of each measured example."""
STUDY = """# A small study: neither clearance nor torque asks for a new solution.
design = "DESIGN"
[vary]
"gear.flank_clearance_um" = { min = 2.0, max = 4.0 }
"load.torque_Nm" = { values = [0.4, 0.5, 0.6] }
[objective]
"backlash_arcsec.total" = "minimize"
[constraint]
"K_b_Nm_per_rad" = { min = 20000.0 }
[run]
method = "sobol"
evaluations = 4
seed = 3
workers = 1
"""
ENOUGH = 16
"""Designs of a study after which it has shown that it runs."""


class EnoughError(ComputationError):
    """A mutation made a good study long."""


@contextmanager
def pool(workers: int, scheduler: str) -> Iterator[WorkerPool]:
    """In place of `worker_pool`: one thread of this process, for `ENOUGH` designs."""
    with ThreadPoolExecutor(1) as executor:
        left = iter(range(ENOUGH))

        def submit(function: Callable, *arguments: object):  # type: ignore[no-untyped-def]
            if next(left, None) is None:
                raise EnoughError("enough")
            return executor.submit(function, *arguments)

        here = WorkerPool(executor, lambda: 1)
        object.__setattr__(here, "submit", submit)
        yield here


def plain(folder: Path, tolerance_pct: float = 5.0) -> Path:
    """The example without holes, a body of revolution, written to `folder`; solved in a second."""
    path = folder / "plain.toml"
    text = CUP.read_text(encoding="utf-8").replace("bolt_count = 6", "bolt_count = 0")
    path.write_text(f"{text}\n[solver]\ntolerance_pct = {tolerance_pct}\n", encoding="utf-8")
    return path


def study(folder: Path) -> str:
    """The study's file, of a plain design in `folder`."""
    return STUDY.replace("DESIGN", str(plain(folder)))


def head(name: str) -> bytes:
    """The first rows of a measured example."""
    lines = (EXAMPLES / "measured" / f"{name}.csv").read_bytes().splitlines(keepends=True)
    return b"".join(lines[: ROWS[name]])


@cache
def base(kind: str, folder: Path) -> bytes:
    """The good file of a kind; `folder` is where the extended model is found, and the study's design lies."""
    if kind == "design":
        return CUP.read_bytes()
    if kind == "study":
        return study(folder).encode()
    if kind == "extended model":
        out = folder / "found"
        sweep = folder / "sweep.csv"
        sweep.write_bytes(head("xb1-40-sweep"))
        flexspline("diagnose", CUP, sweep, *GIVEN, "--out", out, folder=folder)
        return (out / "extended_model.toml").read_bytes()
    return head(
        {"sweep": "xb1-40-sweep", "end points": "size-40-end-points"}.get(kind, "xb1-40-specimens")
    )


SUFFIX = {"design": "toml", "study": "toml", "extended model": "toml"}
KINDS = ("design", "study", "extended model", "sweep", "end points", "specimens")


def words(kind: str, path: Path, torque: Path) -> tuple[object, ...]:
    """The command line that reads a file of a kind."""
    if kind == "design":
        return ("backlash", path, *GIVEN)
    if kind == "study":
        return ("study", path)
    if kind == "extended model":
        return ("predict", CUP, torque, "--model", path)
    return ("diagnose", CUP, path, *GIVEN)
