"""Files are written completely or not at all, and all files of one result together."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from flexspline.geometry.signals import held_signals
from flexspline.pipeline.temporary_files import unfinished, write_unfinished

UMASK = os.umask(0o077)
"""The user's file mode mask; it can be read only by setting it."""
os.umask(UMASK)


def write_bytes(path: Path, data: bytes) -> None:
    """Write `data` beside `path` and move it into place, so that a stop leaves no half file.

    Raises
    ------
    OSError : with the path's name; the earlier file is unchanged.
    """
    path = Path(path)
    write_together(path.parent, {path.name: data})


def write_together(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write all files beside their places, then move them there in one go; their paths.

    A request to end during the moves waits until the last file is moved.

    Raises
    ------
    OSError : with the path's name; the earlier files are unchanged. Nothing is moved if one file cannot be
        replaced.
    """
    folder.mkdir(parents=True, exist_ok=True)
    made: dict[Path, Path] = {}
    try:
        for name, data in files.items():
            part = made[folder / name] = unfinished(folder)
            with named(folder / name):
                write_unfinished(part, data)
            # its 0600 would hide it from the user's colleagues
            os.chmod(part, 0o666 & ~UMASK)
        for path in made:  # before the first is moved: an answer is not half replaced
            refuse_fixed(path)
        with held_signals():
            for path, part in made.items():
                with named(path):
                    os.replace(part, path)
    finally:
        with held_signals():
            for part in made.values():
                part.unlink(missing_ok=True)
    return list(made)


@contextmanager
def named(path: Path) -> Iterator[None]:
    """Errors name the final file; the system's name no file (a full disk) or the unfinished one."""
    try:
        yield
    except OSError as fault:
        raise OSError(fault.errno, fault.strerror, str(path)) from None


def refuse_fixed(path: Path) -> None:
    """Refuse what `os.replace` cannot replace: a folder, or another user's file in a sticky folder.

    Raises
    ------
    OSError : with the path's name.
    """
    try:
        there = path.lstat()
    except FileNotFoundError:
        return
    if stat.S_ISDIR(there.st_mode):
        raise OSError(errno.EISDIR, "is a folder, but a file must be written there", str(path))
    above = path.parent.stat()
    sticky = bool(above.st_mode & stat.S_ISVTX) and hasattr(os, "geteuid")
    if sticky and os.geteuid() not in (0, there.st_uid, above.st_uid):
        reason = "belongs to another user, and this folder does not allow to replace it"
        raise OSError(errno.EPERM, reason, str(path))
