"""Standard output and error: letters that they cannot show, and failed writes.

A terminal gets what its encoding holds and plain letters for the rest. A file or a pipe in another encoding
than UTF-8 gets ASCII, which reads the same in every encoding: ``flexspline init > design.toml`` is a design
file whatever the locale.
"""

from __future__ import annotations

import codecs
import contextlib
import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

from flexspline.geometry.errors import readable
from flexspline.results.exit_status import FAILED, NOBODY_READS
from flexspline.results.plain_letters import ASCII, PLAIN, escaped

STDOUT = "standard output"


@contextmanager
def readable_streams() -> Iterator[None]:
    """Streams that take every letter; what could not be written ends the command with status 1."""
    _open_the_closed()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            _prepare(stream)
    with _libraries_write_to_stderr():
        try:
            yield
        except SystemExit as ended:
            _flush(ended.code)
            raise
        _flush(0)


def show(text: str, json: bool = False) -> None:
    """Print the answer; JSON stays exact where letters are lacking.

    Raises
    ------
    SystemExit : the reader has gone.
    OSError : the answer cannot be written; `filename` names the stream.
    """
    text = readable(text)
    if json and codecs.lookup(sys.stdout.encoding).name != "utf-8":
        text = escaped(text)
    try:
        print(text, flush=True)
    except BrokenPipeError:
        _give_up(sys.stdout)
        raise SystemExit(NOBODY_READS) from None
    except OSError as error:
        _give_up(sys.stdout)
        raise OSError(error.errno, error.strerror, STDOUT) from None


def private_stdout(encoding: str, errors: str | None = None, buffering: int = -1) -> TextIO:
    """Standard output for one writer alone; what others write there goes to standard error from now on."""
    alone = os.fdopen(os.dup(1), "w", buffering, encoding, errors)
    os.dup2(2, 1)
    return alone


@contextmanager
def _libraries_write_to_stderr() -> Iterator[None]:
    """Standard output is for the answer: what a library writes there (oneMKL: "Not enough memory") goes to
    standard error."""
    ours = sys.stdout
    if not isinstance(ours, io.TextIOWrapper) or ours.fileno() != 1:  # somebody took it over
        yield
        return
    ours.flush()
    buffering = 1 if ours.line_buffering else -1
    sys.stdout = private_stdout(ours.encoding, ours.errors, buffering)
    try:
        yield
    finally:
        with contextlib.suppress(OSError, ValueError):
            os.dup2(sys.stdout.fileno(), 1)
            sys.stdout.close()
        sys.stdout = ours


def files_in(folder: str | os.PathLike[str]) -> str:
    """The line that names a folder of results.

    Where letters beyond ASCII become plain ones, the name is written as a string of Python, which names the
    folder that exists.
    """
    name = str(folder)
    narrow = sys.stdout.encoding == ASCII and not name.isascii()
    letters = os.fsencode(name).decode(
        errors="surrogateescape"
    )  # not the bytes of a C locale's name
    return f"files in {ascii(letters) if narrow else name}"


def _prepare(stream: io.TextIOWrapper) -> None:
    wide = codecs.lookup(stream.encoding).name == "utf-8"
    narrow = not wide and (not stream.isatty() or codecs.lookup(stream.encoding).name == "ascii")
    stream.reconfigure(encoding=ASCII if narrow else None, errors=PLAIN)


def _open_the_closed() -> None:
    """A file that the program opens must not become a stream that was closed (``>&-``)."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is not None:
            continue
        # reading only: what is written to a closed output fails, and is said
        nowhere = os.open(os.devnull, os.O_RDONLY if number < 2 else os.O_WRONLY)
        if nowhere != number:
            os.dup2(nowhere, number)
            os.close(nowhere)
        setattr(sys, name, os.fdopen(number, "r" if number == 0 else "w", encoding="utf-8"))


def _flush(code: object) -> None:
    """Say that the last words could not be written, unless the command failed anyway."""
    try:
        sys.stdout.flush()
    except OSError as error:
        _give_up(sys.stdout)
        if code in (0, None):
            if isinstance(error, BrokenPipeError):
                raise SystemExit(NOBODY_READS) from None
            _complain(f"flexspline: {STDOUT}: {error.strerror}")
            raise SystemExit(FAILED) from None
    try:
        sys.stderr.flush()
    except OSError:  # the reader has gone; Python 3.13 would end with status 120
        _give_up(sys.stderr)


def _complain(line: str) -> None:
    with contextlib.suppress(OSError):
        print(line, file=sys.stderr, flush=True)


def _give_up(stream: TextIO) -> None:
    """What is left in the buffer would fail again, with a traceback, when the interpreter ends."""
    with contextlib.suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
