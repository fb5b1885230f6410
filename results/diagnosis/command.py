"""`flexspline diagnose` and `flexspline predict`: their command-line options."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from flexspline.results.exit_status import REFUSED
from flexspline.results.file_names import PREDICTION, of_diagnosis
from flexspline.results.job import answered, begin, tell
from flexspline.results.options import DesignFile, Json, Kb, Ke, Out, stiffness_option
from flexspline.results.streams import show
from flexspline.results.usage import named_file, number, one_of

MeasuredFile = Annotated[
    Path,
    typer.Argument(
        metavar="MEASURED.csv", parser=named_file, help="Torque sweep, end points or specimens."
    ),
]
TorqueFile = Annotated[
    Path,
    typer.Argument(
        metavar="TORQUE.csv",
        parser=named_file,
        help="Torque history: a column torque_Nm, as in measured data.",
    ),
]
ModelPath = Annotated[
    Path,
    typer.Option(
        "--model",
        metavar="MODEL.toml",
        parser=named_file,
        help="Extended model that `diagnose` wrote.",
    ),
]
CountsPerTurn = Annotated[
    float | None,
    typer.Option(
        "--counts-per-turn",
        metavar="N",
        parser=number("4096"),
        help="Encoder counts per turn, where the angle is in counts.",
    ),
]


AGAIN = "; run the same command again: solved stiffnesses are kept, the diagnosis starts from the beginning"
"""To who stops the command."""
TOML = ".toml"
SUM, GEAR = "sum", "gear"
"""What `diagnose` compares a sweep with."""


def in_order(file: Path, other: Path, words: str) -> None:
    """Refuse files in another order than the command takes them: `file` is TOML, `other` is measured.

    Raises
    ------
    typer.Exit : status 2, after one line.
    """
    if file.suffix.lower() != TOML and other.suffix.lower() == TOML:
        tell(
            f"flexspline: {file} is not a TOML file and {other} is one; the order is flexspline {words}"
        )
        raise typer.Exit(REFUSED)


def diagnose(
    design: DesignFile,
    measured: MeasuredFile,
    kb: Kb = None,
    ke: Ke = None,
    counts_per_turn: CountsPerTurn = None,
    against: Annotated[
        str,
        typer.Option(
            "--against",
            metavar=f"[{SUM}|{GEAR}]",
            parser=one_of(SUM, GEAR),
            help="Compare a sweep with the backlash sum's straight line, or with the"
            " torque-angle curve of the whole gear.",
        ),
    ] = SUM,
    out: Out = None,
    json: Json = False,
) -> None:
    """Why measured data differ from the simulation: the causes."""
    in_order(design, measured, "diagnose DESIGN.toml MEASURED.csv")
    given = [name for name, value in (("--Kb", kb), ("--Ke", ke)) if value is not None]
    if against == GEAR and given:
        tell(
            f"flexspline: --against {GEAR}: leave out {' and '.join(given)}: the curve comes from the drawing"
        )
        raise typer.Exit(REFUSED)
    with answered(design, AGAIN):
        from flexspline.pipeline.second_process import second_process
        from flexspline.results.diagnosis.diagnose import diagnose_and_write
        from flexspline.results.figures.diagnosis.captions import CAPTIONS

        job = begin(design, out, of_diagnosis(CAPTIONS))
        stated = (stiffness_option("--Kb", kb), stiffness_option("--Ke", ke))
        with second_process():
            text = diagnose_and_write(job, measured, stated, json, counts_per_turn, against == GEAR)
        show(text, json)


def predict(
    design: DesignFile,
    torque: TorqueFile,
    model: ModelPath,
    counts_per_turn: CountsPerTurn = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Angle for a torque history, by an extended model."""
    order = "predict DESIGN.toml --model MODEL.toml TORQUE.csv"
    in_order(design, torque, order)
    in_order(model, torque, order)
    with answered(design):
        from flexspline.geometry.load import load_design
        from flexspline.results.diagnosis.prediction import predict_and_write
        from flexspline.results.output_folder import folder_of

        gear, folder = load_design(design), folder_of(design, out, (PREDICTION,))
        text = predict_and_write(gear, model, torque, folder, json, counts_per_turn)
        show(text, json)
