"""Command-line options that several commands have."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from flexspline.results.exit_status import REFUSED
from flexspline.results.job import tell
from flexspline.results.usage import named_file, number

DesignFile = Annotated[
    Path, typer.Argument(metavar="DESIGN.toml", parser=named_file, help="The design file.")
]


def _folder(word: str) -> Path:
    """As pathlib reads it, which would take an empty word for the current folder."""
    if not word:
        tell('flexspline: --out = "" names no folder; "." is the current one')
        raise typer.Exit(REFUSED)
    return Path(word)


Out = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        parser=_folder,
        help="Output folder; default: NAME.out/ beside the input.",
    ),
]
_K = number("31300 or 3.13e4, in N·m/rad")
Kb = Annotated[
    float | None,
    typer.Option("--Kb", metavar="X", parser=_K, help="K_b in N·m/rad; it is then not computed."),
]
Ke = Annotated[
    float | None,
    typer.Option("--Ke", metavar="X", parser=_K, help="K_e in N·m/rad; it is then not computed."),
]
Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON, and nothing else.")]


def stiffness_option(name: str, value: float | None) -> float | None:
    """A stiffness given on the command line, checked."""
    from flexspline.geometry.errors import DesignError
    from flexspline.geometry.ranges import STIFFNESS_Nm_per_rad

    if value is not None and value not in STIFFNESS_Nm_per_rad:
        raise DesignError(name, value, f"must be a number {STIFFNESS_Nm_per_rad} N·m/rad")
    return value
