"""Unfinished files have their process in the name; the next command deletes those of killed processes.

A killed process cannot clean up. So that nobody has to guess what is rubbish, every unfinished file or
folder of ours is called ``.flexspline-`` and the process (`pipeline.process_id`); those of processes that
are no more go as soon as another process writes to the same folder. Where that cannot be seen (another
machine's, another container's, from before a reboot), they go when nothing in them has changed for long.
"""

from __future__ import annotations

import errno
import os
import secrets
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from flexspline.pipeline.process_id import parsed, this_process

MARK = ".flexspline-"
FORGOTTEN_S = 10 * 86_400.0
"""After ten days without a change nobody waits for a file: systemd clears /tmp by the same measure."""
NO_ROOM = {
    errno.ENOSPC: "is full",
    errno.EDQUOT: "is full",
    errno.EFBIG: "takes no file of this size",
}
"""What is wrong with a folder that a file does not fit into."""


def mark() -> str:
    """Return how the names of this process's unfinished files begin."""
    return f"{MARK}{this_process()}-"


def unfinished(folder: Path) -> Path:
    """Return a name in `folder` for a new file, which is to be moved into place by `os.replace`.

    Who knows the name before the file is there can remove it whenever a signal comes.
    """
    clear(folder)
    return folder / f"{mark()}{secrets.token_hex(8)}.part"


def write_unfinished(path: Path, data: bytes) -> None:
    """Make an `unfinished` file, to be read by this user alone, and flush it to the disk.

    Raises
    ------
    OSError : nothing is left behind.
    """
    try:
        with open(path, "xb", opener=_private) as out:
            out.write(data)
            out.flush()
            os.fsync(out.fileno())  # a full disk may say so only now
    except BaseException:
        path.unlink(missing_ok=True)
        raise


def _private(path: str, flags: int) -> int:
    return os.open(path, flags, 0o600)


@contextmanager
def scratch_folder(prefix: str) -> Iterator[Path]:
    """A folder for temporary files that goes in the end. To write there alone, not answers: a full disk, or
    a limit on the size of files, is said to be that of the folder for temporary files.

    Raises
    ------
    OSError : with that folder's name in these cases; a copy's own fault would name its source.
    """
    try:
        with tempfile.TemporaryDirectory(prefix=prefix) as folder:
            yield Path(folder)
    except OSError as fault:
        above = temporary_folder()
        if fault.errno not in NO_ROOM or fault.filename == str(above):
            raise  # there is room, or said by one within
        reason = f"{fault.strerror}: the folder for temporary files (TMPDIR) {NO_ROOM[fault.errno]}"
        raise OSError(fault.errno, reason, str(above)) from fault


def temporary_folder() -> Path:
    """The user's folder for temporary files; not this process's own in it, which goes with the process."""
    folder = Path(tempfile.gettempdir())
    return folder.parent if folder.name.startswith(MARK) else folder


def clear(folder: Path) -> list[Path]:
    """Remove what ended processes left, and return it."""
    removed = []
    with suppress(OSError):  # a folder that cannot be listed will say so when it is written to
        for entry in folder.glob(f"{MARK}*"):
            if _abandoned(entry):
                _remove(entry)
                removed.append(entry)
    return removed


def discard(folder: Path, say: Callable[[str], None]) -> None:
    """Clear the folder, and say what was removed."""
    for entry in clear(folder):
        say(f"discarded {entry.name}, left unfinished by a process that was stopped")


def _abandoned(entry: Path) -> bool:
    owner = parsed(entry.name.removeprefix(MARK))
    if owner is None:  # no name of ours
        return False
    fate = owner.fate
    return fate == "gone" or (fate == "unknown" and _unchanged_s(entry) > FORGOTTEN_S)


def _unchanged_s(entry: Path) -> float:
    """Since the last change of a file, or of a folder and anything below it [s]; 0 if it cannot be seen."""
    try:
        below = entry.rglob("*") if entry.is_dir() and not entry.is_symlink() else ()
        return time.time() - max(p.lstat().st_mtime for p in (entry, *below))
    except OSError:
        return 0.0


def _remove(entry: Path) -> None:
    if entry.is_dir() and not entry.is_symlink():
        shutil.rmtree(entry, ignore_errors=True)
    else:
        with suppress(OSError):  # another process was faster
            entry.unlink()
