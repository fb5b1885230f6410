"""The folder that a command writes to: found wanting before the work, not after it."""

from __future__ import annotations

import errno
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from flexspline.geometry.errors import DesignError
from flexspline.pipeline.temporary_files import discard
from flexspline.results.job import tell

FULL = (errno.ENOSPC, errno.EDQUOT)
"""A disk without room is no wrong word of the command line."""


def folder_of(path: Path, out: Path | None) -> Path:
    """Where files go: `--out`, or NAME.out beside the design; what a killed command left there goes.

    Nothing is left in it: a folder that is not there yet is made for a moment.

    Raises
    ------
    DesignError : it cannot be made, or not be written to.
    OSError : the disk is full.
    """
    folder = out if out is not None else path.parent / f"{path.stem}.out"
    verb = "made"
    try:
        if folder.exists() and not folder.is_dir():
            raise DesignError("--out", str(folder), "is a file; name a folder")
        with _there(folder):
            verb = "written to"
            tempfile.TemporaryFile(dir=folder).close()
    except OSError as fault:
        if fault.errno in FULL:
            raise OSError(fault.errno, fault.strerror, str(folder)) from None
        reason = f"cannot be {verb} ({fault.strerror}); name another folder"
        raise DesignError("--out", str(folder), reason) from None
    discard(folder, tell)
    return folder


@contextmanager
def _there(folder: Path) -> Iterator[None]:
    """The folder with those above it while the context lasts; those that were missing go again."""
    missing = []
    for each in (folder, *folder.absolute().parents):
        if each.is_dir():
            break
        missing.append(each)
    with ExitStack() as made:
        for each in reversed(missing):
            with suppress(FileExistsError):  # another command was faster, or `..` led back
                each.mkdir()
                made.callback(_removed, each)
        yield


def _removed(folder: Path) -> None:
    with suppress(OSError):  # another command has begun to write there
        folder.rmdir()
