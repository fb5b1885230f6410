"""What every command does: words of the command line, errors as one line, the design, the folder."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from geometry.design import Design
    from pipeline.parts import Workshop

DesignFile = Annotated[Path, typer.Argument(metavar="DESIGN.toml", help="The design file.")]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out", metavar="DIR", help="Where files go; default beside the input, NAME.out/"
    ),
]
MeasuredFile = Annotated[
    Path, typer.Argument(metavar="MEASURED.csv", help="Torque sweep, end points or specimens.")
]
TorqueFile = Annotated[
    Path, typer.Argument(metavar="TORQUE.csv", help="A history with torque_Nm, as measured data.")
]
ModelPath = Annotated[
    Path, typer.Option("--model", metavar="MODEL.toml", help="An extended model of `diagnose`.")
]
Kb = Annotated[
    float | None, typer.Option("--Kb", metavar="X", help="K_b in N·m/rad, instead of FEA")
]
Ke = Annotated[
    float | None, typer.Option("--Ke", metavar="X", help="K_e in N·m/rad, instead of FEA")
]
Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON, and nothing else.")]
LONGEST_LINE = 2000
"""Letters of a message: a path may take most of them."""


def tell(line: str) -> None:
    """One line of progress or warning, its control characters escaped."""
    from geometry.errors import one_line

    print(one_line(line, LONGEST_LINE), file=sys.stderr, flush=True)


@contextmanager
def answered(path: Path | None = None) -> Iterator[None]:
    """Turn our own errors into one line and an exit status: 2 wrong input, 1 a failed computation."""
    from geometry.errors import ComputationError, DesignError, DesignFileError
    from pipeline.diagnosis.errors import MeasurementError, ModelFileError

    where = f"{path}: " if path else ""
    try:
        yield
    except (MeasurementError, ModelFileError, DesignFileError) as error:  # they name their own file
        tell(f"flexspline: {error}")
        raise typer.Exit(2) from None
    except DesignError as error:
        tell(f"flexspline: {where}{error}")
        raise typer.Exit(2) from None
    except KeyboardInterrupt:
        tell(
            "flexspline: interrupted; finished stages are kept, the same command goes on from there"
        )
        raise typer.Exit(130) from None
    except ComputationError as error:
        tell(f"flexspline: {where}{error}")
        raise typer.Exit(1) from None
    except OSError as error:
        named = f"{error.filename}: " if error.filename else where
        tell(f"flexspline: {named}{error.strerror or error}")
        raise typer.Exit(1) from None
    except MemoryError as error:
        tell(f"flexspline: {where}not enough memory: {error}")
        raise typer.Exit(1) from None


@dataclass(frozen=True)
class Job:
    """A design that loaded, the folder for its files, and a workshop with the cache."""

    design: Design
    shop: Workshop
    folder: Path
    began: float

    @property
    def wall_s(self) -> float:
        return time.monotonic() - self.began


def begin(path: Path, out: Path | None) -> Job:
    """Load the design, say its warnings, open the cache."""
    from geometry.load import load_design
    from geometry.sanity import warnings

    began = time.monotonic()
    design = load_design(path)
    folder = folder_of(path, out)
    for line in warnings(design):
        tell(f"warning: {line}")
    from pipeline.cache import Cache
    from pipeline.chain import CACHED_TYPES
    from pipeline.parts import Workshop
    from pipeline.progress import Progress
    from pipeline.storage import cache_folder

    shop = Workshop(design, Cache(cache_folder(), CACHED_TYPES, tell), Progress(tell))
    return Job(design, shop, folder, began)


def folder_of(path: Path, out: Path | None) -> Path:
    """Where files go: `--out`, or NAME.out beside the design; what a killed command left there goes."""
    from geometry.errors import DesignError
    from pipeline.leftovers import discard

    folder = out if out is not None else path.parent / f"{path.stem}.out"
    if folder.exists() and not folder.is_dir():
        raise DesignError("--out", str(folder), "is a file; name a folder")
    discard(folder, tell)
    return folder


def deliver(folder: Path, record: dict[str, Any], as_json: bool) -> None:
    """Write result.json and print it, for machines or for people."""
    from results.console import table
    from results.records import as_json as text
    from results.records import write_record

    write_record(folder, record)
    print(text(record) if as_json else table(record, folder))


def stiffness_option(name: str, value: float | None) -> float | None:
    """A stiffness given on the command line, checked."""
    from geometry.errors import DesignError

    if value is not None and not 0 < value < float("inf"):
        raise DesignError(name, value, "must be a positive number of N·m/rad")
    return value
