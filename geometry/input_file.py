"""Reads input files safely: only regular files within a size limit, no pipes or devices."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from flexspline.geometry.errors import FlexsplineError

STDIN = "-"
DEVICES = Path("/dev")
KINDS = (
    (stat.S_ISDIR, "is a directory"),
    (stat.S_ISFIFO, "is a pipe; write its content to a file first"),
    (stat.S_ISSOCK, "is a socket"),
    (stat.S_ISCHR, "is a device"),
    (stat.S_ISBLK, "is a device"),
)
"""What is not read: a pipe may wait for ever, a device such as /dev/zero never ends."""
LARGEST_TOML_BYTES = 1_000_000
"""Of a design, a study or an extended model, which take 2 to 5 kB: a file beyond this is some other file."""


class InputFileError(FlexsplineError, ValueError):
    """A file that cannot be read; the message is one clause that says why."""


class NoFileNameError(InputFileError, TypeError):
    """A function was given something else than the name of a file."""


def file_name(given: object, what: str = "") -> Path:
    """A path where one is given; `what` kind of file it should name, for the error.

    Raises
    ------
    NoFileNameError

    Examples
    --------
    >>> try:
    ...     file_name({"torque_Nm": [1.0]}, "measured data")
    ... except FlexsplineError as fault:
    ...     print(fault)
    measured data: a dict is not the name of a file
    """
    if not isinstance(given, str | os.PathLike):
        words = f"a {type(given).__name__} is not the name of a file"
        raise NoFileNameError(f"{what}: {words}" if what else words)
    return Path(given)


def read_input(path: Path | str, largest_bytes: int, what: str) -> bytes:
    """The bytes of a file; `what` it should be, and `largest_bytes` that such a file may have.

    A symbolic link to a regular file is followed. The file is looked at only once it is open, so that
    it cannot become another one in between.

    Raises
    ------
    InputFileError : no such file, not a regular file, too large, not readable.
    """
    if str(file_name(path)) == STDIN:
        raise InputFileError("standard input is not read; name a file")
    try:
        # a pipe is opened without waiting for who writes to it; Windows has neither
        handle = os.open(
            path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
        )
    except FileNotFoundError:
        raise InputFileError("no such file") from None
    except (OSError, ValueError) as fault:  # ValueError: a NUL in the name
        raise InputFileError(_unreadable(Path(path), fault)) from None
    try:
        mode = os.fstat(handle).st_mode
        if not stat.S_ISREG(mode):
            raise InputFileError(_kind(mode))
        if _is_descriptor(Path(path)):
            raise InputFileError("stands for an open file; name that file itself")
        with os.fdopen(handle, "rb", closefd=False) as file:
            data = file.read(largest_bytes + 1)
        size = max(len(data), os.fstat(handle).st_size)
    except OSError as fault:
        raise InputFileError(f"cannot be read ({fault.strerror or fault})") from None
    finally:
        os.close(handle)
    if size > largest_bytes:
        raise InputFileError(f"{size} bytes; {what} has at most {largest_bytes} bytes")
    return data


def _is_descriptor(path: Path) -> bool:
    """Whether a name such as /dev/stdin, /dev/fd/3 or /proc/self/fd/0 is a number of an open file.

    Results go beside the file that is named: that folder is the system's.
    """
    folder = path.parent.resolve()
    return folder == DEVICES or (folder.name == "fd" and folder.parts[1] in ("dev", "proc"))


def _kind(mode: int) -> str:
    return next((words for is_kind, words in KINDS if is_kind(mode)), "is not a regular file")


def _unreadable(path: Path, fault: OSError | ValueError) -> str:
    """Why a file could not be opened; some systems do not open directories or sockets at all."""
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):
        mode = stat.S_IFREG
    if not stat.S_ISREG(mode):
        return _kind(mode)
    reason = fault.strerror if isinstance(fault, OSError) and fault.strerror else str(fault)
    return f"cannot be read ({reason})"
