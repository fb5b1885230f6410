"""Files appear whole or not at all, and those of one answer together."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from flexspline.pipeline.temporary_files import unfinished

UMASK = os.umask(0o077)
"""What the user keeps from others; it can be read only by setting it."""
os.umask(UMASK)


def write_bytes(path: Path, data: bytes) -> None:
    """Write `data` beside `path` and move it into place, so that a stop leaves no half file.

    Raises
    ------
    OSError : with the path's name; what was there before still is.
    """
    path = Path(path)
    write_together(path.parent, {path.name: data})


def write_together(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write all files beside their places, then move them there in one go; their paths.

    A request to end that comes while they are moved waits until the last one is.

    Raises
    ------
    OSError : with the path's name; what was there before still is, unless a move failed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    made: dict[Path, Path] = {}
    try:
        for name, data in files.items():
            made[folder / name] = unfinished(folder, data)
            # mkstemp's 0600 would hide it from the user's colleagues
            os.chmod(made[folder / name], 0o666 & ~UMASK)
        with _not_stopped():
            for path, part in made.items():
                try:
                    os.replace(part, path)
                except OSError as fault:
                    raise OSError(fault.errno, fault.strerror, str(path)) from None
    finally:
        for part in made.values():
            part.unlink(missing_ok=True)
    return list(made)


@contextmanager
def _not_stopped() -> Iterator[None]:
    """Requests to end wait; only the main thread hears of them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    before = {
        each: signal.signal(each, lambda number, _: came.append(number))
        for each in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)
    if came:
        signal.raise_signal(came[0])
