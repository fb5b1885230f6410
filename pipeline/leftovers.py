"""Unfinished files name the process that writes them; what a killed process left, the next one clears.

A killed process cannot clean up. So that nobody has to guess what is rubbish, every unfinished file or
folder of ours is called ``.flexspline-HOST-PID-…``; those of processes of this machine that are no more
go as soon as another process writes to the same folder. Another machine's are left alone.
"""

from __future__ import annotations

import os
import shutil
import socket
import tempfile
import zlib
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

MARK = ".flexspline-"


def mark() -> str:
    """How the names of this process's unfinished files begin."""
    return f"{_of_host()}{os.getpid()}-"


def unfinished(folder: Path, data: bytes) -> Path:
    """A new file in `folder`, flushed to the disk, to be moved into place by `os.replace`.

    Raises
    ------
    OSError : nothing is left behind.
    """
    clear(folder)
    handle, name = tempfile.mkstemp(dir=folder, prefix=mark(), suffix=".part")
    try:
        with os.fdopen(handle, "wb") as out:
            out.write(data)
            out.flush()
            os.fsync(out.fileno())  # a full disk may say so only now
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
    return Path(name)


def clear(folder: Path) -> list[Path]:
    """Remove what processes of this machine left that are no more; what was removed."""
    gone = []
    with suppress(OSError):  # a folder that cannot be listed will say so when it is written to
        for entry in folder.glob(f"{_of_host()}*"):
            pid = entry.name.removeprefix(_of_host()).partition("-")[0]
            if pid.isdecimal() and not _lives(int(pid)):
                _remove(entry)
                gone.append(entry)
    return gone


def discard(folder: Path, say: Callable[[str], None]) -> None:
    """`clear`, and say what went."""
    for entry in clear(folder):
        say(f"discarded {entry.name}, left unfinished by a process that was stopped")


def _of_host() -> str:
    return f"{MARK}{zlib.crc32(socket.gethostname().encode()):08x}-"


def _lives(pid: int) -> bool:
    import psutil

    return pid == os.getpid() or psutil.pid_exists(pid)


def _remove(entry: Path) -> None:
    if entry.is_dir() and not entry.is_symlink():
        shutil.rmtree(entry, ignore_errors=True)
    else:
        with suppress(OSError):  # another process was faster
            entry.unlink()
