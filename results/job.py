"""Common steps of every command: errors as one line, the design, the folder, the result."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from flexspline.results.exit_status import FAILED, INTERRUPTED, REFUSED

if TYPE_CHECKING:
    from flexspline.geometry.design import Design
    from flexspline.pipeline.parts import AnalysisContext
    from flexspline.pipeline.progress import Progress
    from flexspline.pipeline.stiffnesses import Stiffnesses
    from flexspline.results.report.attached import Attachment

LONGEST_LINE = 2000
"""Letters of a message: a path may take most of them."""


def tell(line: str) -> None:
    """One line of progress or warning, its control characters escaped.

    Line and line end are one write: several threads print, and lines must not mix.
    """
    from flexspline.geometry.errors import one_line

    with suppress(OSError):  # the reader has gone: no reason to stop
        print(f"{one_line(line, LONGEST_LINE)}\n", end="", file=sys.stderr, flush=True)


RESUMES = "; run the same command again to resume"
"""Where finished stages, or designs of a study, are kept."""


@contextmanager
def answered(path: Path | None = None, interrupted: str = "") -> Iterator[None]:
    """Turn our own errors into one line and an exit status: 2 wrong input, 1 a failed computation.

    `interrupted`: what to add where a user stops the command.
    """
    from flexspline.geometry.errors import ComputationError, DesignError, DesignFileError, why_of
    from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError, ModelFileError
    from flexspline.pipeline.errors import NestingError
    from flexspline.results.folder_lock import held_until_the_end

    where = f"{path}: " if path else ""
    try:
        with held_until_the_end():
            yield
    except (MeasurementError, ModelFileError, DesignFileError) as error:  # they name their own file
        tell(f"flexspline: {error}")
        raise typer.Exit(REFUSED) from None
    except DesignError as error:
        of_an_option = error.key.startswith("--")  # which is no fault of the file
        tell(f"flexspline: {'' if of_an_option else where}{error}")
        raise typer.Exit(REFUSED) from None
    except KeyboardInterrupt:
        tell(f"flexspline: interrupted{interrupted}")
        raise typer.Exit(INTERRUPTED) from None
    except (ComputationError, NestingError) as error:
        tell(f"flexspline: {where}{error}")
        raise typer.Exit(FAILED) from None
    except OSError as error:
        tell(f"flexspline: {why_of(error, where)}")
        raise typer.Exit(FAILED) from None
    except MemoryError as error:
        tell(f"flexspline: {where}not enough memory: {error}")
        raise typer.Exit(FAILED) from None


@dataclass(frozen=True)
class Job:
    """A design that loaded, and the folder for its files."""

    design: Design
    progress: Progress
    folder: Path
    file: Attachment
    began: float

    @cached_property
    def context(self) -> AnalysisContext:
        """The design with the cache; created only where something is solved, because it loads the solvers."""
        from flexspline.pipeline.analysis import analysis_context

        return analysis_context(self.design, tell, self.progress)

    @property
    def wall_s(self) -> float:
        return time.monotonic() - self.began


def begin(path: Path, out: Path | None, files: Iterable[str]) -> Job:
    """Load the design and say its warnings; `files`: names of those that are written."""
    from flexspline.geometry.load import design_from, read_raw, tables_from
    from flexspline.geometry.sanity import warnings
    from flexspline.results.output_folder import folder_of

    began = time.monotonic()
    raw = read_raw(path)
    design = design_from(tables_from(raw, path))
    folder = folder_of(path, out, files)
    for line in warnings(design):
        tell(f"warning: {line}")
    from flexspline.pipeline.progress import Progress
    from flexspline.results.report.attached import Attachment

    return Job(design, Progress(tell), folder, Attachment(path.name, raw, "Design file"), began)


def deliver(job: Job, record: dict[str, Any], as_json: bool) -> None:
    """Write result.json and print it."""
    put(job.folder, record)
    present(job, record, as_json)


def put(folder: Path, record: dict[str, Any]) -> None:
    """Write result.json; say where an earlier one with more figures is kept."""
    from flexspline.results.earlier import write_result

    if note := write_result(folder, record):
        tell(f"note: {note}")


def present(job: Job, record: dict[str, Any], as_json: bool) -> None:
    """Print a record, for machines or for people."""
    from flexspline.results.console import table
    from flexspline.results.limit_words import stiffness_notes
    from flexspline.results.records import as_json as text
    from flexspline.results.streams import show

    if as_json:
        show(text(record), as_json)
    else:
        notes = stiffness_notes(job.design) if "K_e_Nm_per_rad" in record else {}
        show(table(record, job.folder, notes))


def keep(job: Job, stiffnesses: Stiffnesses, as_json: bool) -> None:
    """Write and print result.json with the computed stiffnesses, and warn of missing ones."""
    from flexspline.results.records import heading, stiffness_record

    warn(job.design, stiffnesses)
    record = {**heading(job.design), **stiffness_record(job.design, stiffnesses, job.wall_s)}
    deliver(job, record, as_json)


def warn(design: Design, stiffnesses: Stiffnesses) -> None:
    """A line on stderr for each figure that missed its tolerance, or is missing."""
    from flexspline.results.warned import shortfalls

    tell_all(shortfalls(design, stiffnesses))


def tell_all(warnings: Iterable[str]) -> list[str]:
    """A line on stderr for each warning; the same again, for result.json."""
    lines = list(warnings)
    for line in lines:
        tell(f"warning: {line}")
    return lines


@contextmanager
def kept(job: Job, as_json: bool) -> Iterator[None]:
    """If a necessary figure failed, write the others before the error is raised."""
    from flexspline.pipeline.stiffnesses import NotFoundError

    try:
        yield
    except NotFoundError as fault:
        keep(job, fault.stiffnesses, as_json)
        raise
