"""The `flexspline` command. Each subcommand is thin: read, ask the pipeline, write, print."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from flexspline.results.diagnosis.command import diagnose, predict
from flexspline.results.file_names import FORMATS, GEAR, ONE_RECORD, RUN, of_export
from flexspline.results.job import (
    RESUMES,
    answered,
    begin,
    deliver,
    keep,
    kept,
    present,
    tell,
    tell_all,
    warn,
)
from flexspline.results.options import DesignFile, Json, Kb, Ke, Out, stiffness_option
from flexspline.results.streams import show
from flexspline.results.studio.command import register as register_studio
from flexspline.results.study.command import sensitivity, study
from flexspline.results.usage import Commands, named_file, number, whole_number

app = typer.Typer(
    name="flexspline",
    cls=Commands,
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["--help", "-h"]},
)


def _version(wanted: bool) -> None:
    if wanted:
        from flexspline import __version__

        show(__version__)
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Print the version."),
    ] = False,
) -> None:
    """Strain wave gears: from a design file to stiffness, stress and backlash."""


@app.command()
def run(
    design: DesignFile,
    model: Annotated[
        Path | None,
        typer.Option(
            "--model",
            metavar="MODEL.toml",
            parser=named_file,
            help="Add the backlash of this extended model (from `diagnose`).",
        ),
    ] = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Everything: stiffness, stress, backlash, whole gear, report."""
    with answered(design, RESUMES):
        measured = None
        if model is not None:
            from flexspline.pipeline.diagnosis.model.model_file import read_model_file

            measured = read_model_file(model)
        job = begin(design, out, RUN)
        if measured is not None:
            from flexspline.results.diagnosis.model_notes import model_warnings

            tell_all(model_warnings(measured, job.design))
        from flexspline.results.run import run_answer

        deliver(job, run_answer(job, measured, json), json)


@app.command()
def stiffness(design: DesignFile, out: Out = None, json: Json = False) -> None:
    """Stiffness of flexspline and shaft, K_b and K_e, with bounds."""
    with answered(design, RESUMES):
        job = begin(design, out, ONE_RECORD)
        from flexspline.pipeline.analysis import stiffnesses
        from flexspline.pipeline.second_process import second_process

        with second_process():
            solved = stiffnesses(job.context)
        keep(job, solved, json)
        solved.require(job.design)


@app.command()
def backlash(
    design: DesignFile,
    kb: Kb = None,
    ke: Ke = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Backlash as the sum of four terms."""
    with answered(design, RESUMES):
        job = begin(design, out, ONE_RECORD)
        from flexspline.pipeline.second_process import second_process
        from flexspline.results.backlash import backlash_answer

        with kept(job, json), second_process():
            record = backlash_answer(
                job, stiffness_option("--Kb", kb), stiffness_option("--Ke", ke)
            )
        deliver(job, record, json)


@app.command()
def gear(design: DesignFile, out: Out = None, json: Json = False) -> None:
    """Torque and angle of the whole gear: K1 to K3, lost motion."""
    with answered(design, RESUMES):
        job = begin(design, out, GEAR)
        from flexspline.pipeline.analysis import stiffnesses
        from flexspline.pipeline.gear.gear_curve import gear_curve
        from flexspline.results.gear import gear_record, write_gear
        from flexspline.results.gear_words import gear_notes, gear_warnings

        curve = gear_curve(job.context)
        shaft = stiffnesses(job.context, flexspline=False)
        for line in gear_notes(curve):
            tell(f"note: {line}")
        warn(job.design, shaft)
        tell_all(gear_warnings(curve))
        record = gear_record(job.design, curve, shaft, job.wall_s)
        write_gear(job.folder, curve, record)
        present(job, record, json)


@app.command()
def export(
    design: DesignFile,
    out: Out = None,
    deck: Annotated[
        bool,
        typer.Option("--deck", help="Also write the torsion case as CalculiX/Abaqus decks (.inp)."),
    ] = False,
    formats: Annotated[
        list[str] | None,
        typer.Option(
            "--format",
            metavar="FORMAT",
            help="Also write the whole parts' meshes with named patches:"
            f" {', '.join(FORMATS)}; several separated by commas, or the option again.",
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Write both parts as STEP and STL, the solved fields as VTU."""
    with answered(design, RESUMES):
        from flexspline.results.mesh_files import chosen_formats

        chosen = chosen_formats(formats or ())
        job = begin(design, out, of_export(chosen, deck))
        from flexspline.results.export import write_exports
        from flexspline.results.records import as_json, heading

        files = write_exports(job.context, job.folder, chosen, deck)
        record = {**heading(job.design), "files": [str(f) for f in files]}
        show(as_json(record) if json else "\n".join(record["files"]), json)


app.command()(diagnose)
app.command()(predict)


@app.command()
def init(
    kind: Annotated[str, typer.Argument(metavar="[cup|hat]", help="Kind of flexspline.")] = "cup",
    size: Annotated[
        float | None,
        typer.Option(
            metavar="S",
            parser=number("25, as a catalogue names it"),
            help="Catalogue size: dimensions in proportion, assumptions marked.",
        ),
    ] = None,
    ratio: Annotated[
        int | None,
        typer.Option(
            metavar="I", parser=whole_number, help="Reduction ratio, with --size; default 100."
        ),
    ] = None,
    rated: Annotated[
        float | None,
        typer.Option(
            metavar="T",
            parser=number("87, in N·m"),
            help="Rated torque in N·m, with --size; default in proportion.",
        ),
    ] = None,
) -> None:
    """Print a commented design file to start from."""
    with answered():
        from flexspline.geometry.load import design_from, tables_from
        from flexspline.geometry.sanity import warnings
        from flexspline.results.first_design import first_design

        text = first_design(kind, size, ratio, rated)
        tell_all(warnings(design_from(tables_from(text.encode(), "init"))))
        show(text.removesuffix("\n"))


@app.command()
def schema() -> None:
    """Print the JSON Schema of design files, for editors."""
    with answered():
        from flexspline.geometry.template import json_schema
        from flexspline.results.records import as_json

        show(as_json(json_schema()), json=True)


app.command()(study)
app.command()(sensitivity)
register_studio(app)

if __name__ == "__main__":
    from flexspline.results.entry import main

    main()
