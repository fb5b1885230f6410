"""`flexspline studio`: the live page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from flexspline.results.job import answered
from flexspline.results.usage import named_file, whole_number


def register(app: typer.Typer) -> None:
    """Add the command to the app."""
    app.command()(studio)


def studio(
    design: Annotated[
        Path | None,
        typer.Argument(
            metavar="[DESIGN.toml]",
            parser=named_file,
            help="The design file; default: a cup to start from.",
        ),
    ] = None,
    host: Annotated[
        str, typer.Option(help="Address to listen on; 127.0.0.1 is reached from this machine only.")
    ] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(metavar="N", parser=whole_number, help="Port; 0: any free one.")
    ] = 0,
    browser: Annotated[bool, typer.Option(help="Open the page in the browser.")] = True,
) -> None:
    """Live page in the browser: a slider for every dimension."""
    with answered(design):
        from flexspline.results.studio.serve import serve, starting_design

        serve(starting_design(design), host, port, browser)
