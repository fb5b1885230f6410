"""Files appear whole or not at all."""

from __future__ import annotations

import os
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
    path.parent.mkdir(parents=True, exist_ok=True)
    made = unfinished(path.parent, data)
    try:
        os.chmod(made, 0o666 & ~UMASK)  # mkstemp's 0600 would hide it from the user's colleagues
        os.replace(made, path)
    except OSError as fault:
        raise OSError(fault.errno, fault.strerror, str(path)) from None
    finally:
        made.unlink(missing_ok=True)
