"""A command line that cannot be read is answered as any other wrong input: one line, exit status 2."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import typer
from typer.core import TyperGroup

from flexspline.results.job import tell

UsageError: Any = typer.BadParameter.__mro__[1]
"""Typer carries a click of its own from some release on, and names this class nowhere."""


class Commands(TyperGroup):
    """The program's commands."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        with answered_in_one_line():
            return super().parse_args(ctx, args)

    def invoke(self, ctx: Any) -> Any:
        with answered_in_one_line():  # a command reads its own words in here
            return super().invoke(ctx)


@contextmanager
def answered_in_one_line() -> Iterator[None]:
    """Raises typer.Exit(2) in place of an error of use."""
    try:
        yield
    except UsageError as wrong:
        if type(wrong).show is not UsageError.show:  # no words at all: the help is shown
            raise
        command = wrong.ctx.command_path if wrong.ctx else "flexspline"
        tell(f"flexspline: {wrong.format_message().rstrip('.')}; see {command} --help")
        raise typer.Exit(2) from None


def number(text: str) -> float:
    """Of an option; every float, as Python reads it.

    Raises
    ------
    typer.BadParameter
    """
    try:
        return float(text)
    except ValueError:
        raise typer.BadParameter(f'"{text}" must be a number, such as 31300 or 3.13e4') from None


def whole_number(text: str) -> int:
    """Of an option.

    Raises
    ------
    typer.BadParameter
    """
    try:
        return int(text)
    except ValueError:
        raise typer.BadParameter(f'"{text}" must be a whole number') from None
