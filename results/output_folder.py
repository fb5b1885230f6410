"""The output folder of a command, checked before the work."""

from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from flexspline.geometry.errors import DesignError
from flexspline.pipeline.default_folder import default_folder
from flexspline.pipeline.temporary_files import discard
from flexspline.results.atomic import refuse_fixed
from flexspline.results.folder_lock import hold, locked
from flexspline.results.job import tell

FULL = (errno.ENOSPC, errno.EDQUOT)
"""A full disk is not a wrong option."""


def folder_of(path: Path, out: Path | None, files: Iterable[str], shared: bool = False) -> Path:
    """The folder for `files`: `--out`, or NAME.out beside the design.

    Files that a killed command left there are deleted. The folder is locked until the command ends
    (`folder_lock`); `shared`: other commands may share it. A new folder that stays empty is deleted again.

    Raises
    ------
    DesignError : it cannot be made, or not be written to, or another command writes there, or what stands in
        the place of one of the files cannot be replaced.
    OSError : the disk is full.
    """
    folder = out if out is not None else default_folder(path)
    try:
        if folder.exists() and not folder.is_dir():
            raise DesignError("--out", str(folder), "is a file; name a folder")
        free = hold(_own(folder, shared))
    except OSError as fault:
        if fault.errno in FULL:
            raise OSError(fault.errno, fault.strerror, str(folder)) from None
        verb = "written to" if os.path.isdir(folder) else "made"  # Path.is_dir fails at a long name
        reason = f"cannot be {verb} ({fault.strerror}); name another folder"
        raise DesignError("--out", str(folder), reason) from None
    if not free:
        reason = "another flexspline command is writing there; wait until it ends, or name another folder"
        raise DesignError("--out", str(folder), reason)
    discard(folder, tell)
    for name in files:
        try:
            refuse_fixed(folder / name)
        except OSError as fault:
            reason = f"its {name} {fault.strerror}; name another folder"
            raise DesignError("--out", str(folder), reason) from None
    return folder


@contextmanager
def _own(folder: Path, shared: bool) -> Iterator[bool]:
    """The folder, made where it is missing and found to be writable; whether no other command has it."""
    with _there(folder):
        tempfile.TemporaryFile(dir=folder).close()
        with locked(folder, shared) as free:
            yield free


@contextmanager
def _there(folder: Path) -> Iterator[None]:
    """Create the folder and those above it; at the end the new ones are deleted if they are empty."""
    missing = []
    for path in (folder, *folder.absolute().parents):
        if path.is_dir():
            break
        missing.append(path)
    with ExitStack() as made:
        for path in reversed(missing):
            with suppress(FileExistsError):  # another command was faster, or `..` led back
                path.mkdir()
                made.callback(_removed, path)
        yield


def _removed(folder: Path) -> None:
    with suppress(OSError):  # another command has begun to write there
        folder.rmdir()
