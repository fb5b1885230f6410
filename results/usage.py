"""Errors of the command line are handled as any other wrong input: one line, exit status 2."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import typer
from typer.core import TyperGroup

from flexspline.geometry.listed import joined
from flexspline.results.exit_status import FAILED, REFUSED
from flexspline.results.job import tell

T = TypeVar("T")
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
    """Raises typer.Exit: 2 in place of an error of use, 1 where a help text cannot be written."""
    try:
        yield
    except BrokenPipeError:  # the reader has gone
        raise
    except OSError as error:
        from flexspline.geometry.errors import why_of
        from flexspline.results.streams import STDOUT

        tell(f"flexspline: {why_of(error, f'{STDOUT}: ')}")
        raise typer.Exit(FAILED) from None
    except UsageError as wrong:
        if type(wrong).show is not UsageError.show:  # no words at all: the help is shown
            raise
        command = wrong.ctx.command_path if wrong.ctx else "flexspline"
        tell(f"flexspline: {wrong.format_message().rstrip('.')}; see {command} --help")
        raise typer.Exit(REFUSED) from None


def _reader(kind: Callable[[str], T], what: str) -> Callable[[str], T]:
    """Of an option's word; raises typer.BadParameter with the word in it."""

    def read(text: str) -> T:
        try:
            return kind(text)
        except ValueError:
            raise typer.BadParameter(f'"{text}" must be {what}') from None

    return read


def number(example: str) -> Callable[[str], float]:
    """Of a number without its unit: every float, as Python reads it. `example`: what it may be."""
    return _reader(float, f"a number without a unit, such as {example}")


whole_number = _reader(int, "a whole number")


def _named(text: str) -> Path:
    if not text:
        raise ValueError
    return Path(text)


named_file = _reader(_named, "the name of a file")
"""As pathlib reads it, which would take an empty word for the current folder."""


def one_of(*words: str) -> Callable[[str], str]:
    """Of a few words."""

    def chosen(text: str) -> str:
        if text not in words:
            raise ValueError
        return text

    return _reader(chosen, joined(words, "or"))
