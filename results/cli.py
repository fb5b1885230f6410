"""The `flexspline` command. Each subcommand is thin: read, ask the pipeline, write, print."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

if TYPE_CHECKING:
    from geometry.design import Design
    from pipeline.parts import Workshop

app = typer.Typer(
    name="flexspline",
    help="Strain wave gears: from a design file to stiffness, stress and backlash.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

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


def main() -> None:
    """Entry point of the console script."""
    app()


def _tell(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


@contextmanager
def _answered(path: Path | None = None) -> Iterator[None]:
    """Turn our own errors into one line and an exit status: 2 wrong input, 1 a failed computation."""
    from geometry.errors import ComputationError, DesignError
    from pipeline.diagnosis.errors import MeasurementError, ModelFileError

    where = f"{path}: " if path else ""
    try:
        yield
    except (MeasurementError, ModelFileError) as error:  # they name their own file
        _tell(f"flexspline: {error}")
        raise typer.Exit(2) from None
    except DesignError as error:
        _tell(f"flexspline: {where}{error}")
        raise typer.Exit(2) from None
    except KeyboardInterrupt:
        _tell(
            "flexspline: interrupted; finished stages are kept, the same command goes on from there"
        )
        raise typer.Exit(130) from None
    except ComputationError as error:
        _tell(f"flexspline: {where}{error}")
        raise typer.Exit(1) from None
    except OSError as error:
        _tell(f"flexspline: {error.filename or where}: {error.strerror or error}")
        raise typer.Exit(1) from None


@dataclass(frozen=True)
class _Job:
    """A design that loaded, the folder for its files, and a workshop with the cache."""

    design: Design
    shop: Workshop
    folder: Path
    began: float

    @property
    def wall_s(self) -> float:
        return time.monotonic() - self.began


def _job(path: Path, out: Path | None) -> _Job:
    from geometry.load import load_design
    from geometry.sanity import warnings

    began = time.monotonic()
    design = load_design(path)
    folder = _folder(path, out)
    for line in warnings(design):
        _tell(f"warning: {line}")
    from pipeline.cache import Cache
    from pipeline.chain import CACHED_TYPES
    from pipeline.parts import Workshop
    from pipeline.progress import Progress
    from pipeline.storage import cache_folder

    shop = Workshop(design, Cache(cache_folder(), CACHED_TYPES, _tell), Progress(_tell))
    return _Job(design, shop, folder, began)


def _folder(path: Path, out: Path | None) -> Path:
    from geometry.errors import DesignError

    folder = out if out is not None else path.parent / f"{path.stem}.out"
    if folder.exists() and not folder.is_dir():
        raise DesignError("--out", str(folder), "is a file; name a folder")
    return folder


def _deliver(folder: Path, record: dict[str, Any], as_json: bool) -> None:
    from results.console import table
    from results.records import as_json as text
    from results.records import write_record

    write_record(folder, record)
    print(text(record) if as_json else table(record, folder))


@app.command()
def run(
    design: DesignFile,
    model: Annotated[
        Path | None,
        typer.Option("--model", metavar="MODEL.toml", help="Add what this extended model found."),
    ] = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """The whole way: CAD, mesh, K_b, K_e, backlash, pictures and report.pdf."""
    with _answered(design):
        from pipeline.diagnosis.model_file import read_model_file

        measured = read_model_file(model) if model is not None else None
        job = _job(design, out)
        from pipeline.chain import run as run_chain
        from pipeline.diagnosis.extended_backlash import extended_backlash
        from results.pictures import write_pictures
        from results.records import extended_record, run_record
        from results.report.build import write_run_report

        result = run_chain(job.shop)
        extended = measured and extended_backlash(
            result.backlash, measured.model, job.design.load.torque_Nm
        )
        pictures = write_pictures(job.shop, result, job.folder, extended)
        with job.shop.progress.stage("report"):
            name = measured.path.name if measured else ""
            write_run_report(job.folder / "report.pdf", result, pictures, name)
        record = run_record(result, job.wall_s)
        if measured and extended:
            record |= extended_record(extended, name)
        _deliver(job.folder, record, json)


@app.command()
def stiffness(design: DesignFile, out: Out = None, json: Json = False) -> None:
    """K_b and K_e with error bounds only."""
    with _answered(design):
        job = _job(design, out)
        from pipeline.chain import stiffnesses
        from results.records import heading, stiffness_record

        found = stiffnesses(job.shop)
        record = {**heading(job.design), **stiffness_record(job.design, found, job.wall_s)}
        _deliver(job.folder, record, json)


@app.command()
def backlash(
    design: DesignFile,
    kb: Kb = None,
    ke: Ke = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """The four-term backlash sum."""
    with _answered(design):
        job = _job(design, out)
        record = _backlash_record(job, _stiffness_option("--Kb", kb), _stiffness_option("--Ke", ke))
        _deliver(job.folder, record, json)


def _stiffness_option(name: str, value: float | None) -> float | None:
    from geometry.errors import DesignError

    if value is not None and not 0 < value < float("inf"):
        raise DesignError(name, value, "must be a positive number of N·m/rad")
    return value


def _backlash_record(job: _Job, kb: float | None, ke: float | None) -> dict[str, Any]:
    from pipeline.backlash import backlash as total
    from results.records import backlash_record, heading, stiffness_record

    record = heading(job.design)
    if kb is None or ke is None:
        from pipeline.chain import stiffnesses

        rim = job.design.solver.load_case == "lobes"
        found = stiffnesses(job.shop, flexspline=kb is None, shaft=ke is None, rim=rim)
        record |= stiffness_record(job.design, found, job.wall_s)
        kb = kb or found.in_sum(job.design).K_Nm_per_rad
        ke = ke or found.shaft.K_Nm_per_rad
    record["K_series_Nm_per_rad"] = 1 / (1 / kb + 1 / ke)
    return record | backlash_record(total(job.design, kb, ke))


@app.command()
def export(
    design: DesignFile,
    out: Out = None,
    deck: Annotated[
        bool, typer.Option("--deck", help="Also the torsion case as CalculiX/Abaqus decks (.inp).")
    ] = False,
    json: Json = False,
) -> None:
    """STEP and STL of both parts, and the solved fields as VTU."""
    with _answered(design):
        job = _job(design, out)
        from results.export import write_decks, write_exports
        from results.records import as_json, heading

        files = write_exports(job.shop, job.folder)
        files += write_decks(job.shop, job.folder) if deck else []
        record = {**heading(job.design), "files": [str(f) for f in files]}
        print(as_json(record) if json else "\n".join(record["files"]))


@app.command()
def diagnose(
    design: DesignFile,
    measured: MeasuredFile,
    kb: Kb = None,
    ke: Ke = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """What the simulation gets wrong, and why, from measured data."""
    with _answered(design):
        from results.diagnosis.command import diagnose_and_write

        job = _job(design, out)
        given = (_stiffness_option("--Kb", kb), _stiffness_option("--Ke", ke))
        print(diagnose_and_write(job.shop, measured, given, job.folder, json))


@app.command()
def predict(
    design: DesignFile,
    torque: TorqueFile,
    model: ModelPath,
    out: Out = None,
    json: Json = False,
) -> None:
    """The angle for a torque history, by an extended model."""
    with _answered(design):
        from geometry.load import load_design
        from results.diagnosis.prediction import predict_and_write

        gear, folder = load_design(design), _folder(design, out)
        print(predict_and_write(gear, model, torque, folder, json, _tell))


@app.command()
def init(
    kind: Annotated[str, typer.Argument(metavar="[cup|hat]", help="Kind of flexspline.")] = "cup",
) -> None:
    """Print a commented design file to start from."""
    with _answered():
        from geometry.errors import DesignError
        from geometry.template import template

        kinds: dict[str, Literal["cup", "hat"]] = {"cup": "cup", "hat": "hat"}
        if kind not in kinds:
            raise DesignError("kind", kind, 'must be "cup" or "hat"')
        print(template(kinds[kind]), end="")


@app.command()
def schema() -> None:
    """Print the design file's JSON Schema, for editors that complete and check it."""
    with _answered():
        from geometry.template import json_schema
        from results.records import as_json

        print(as_json(json_schema()))


if __name__ == "__main__":
    main()
