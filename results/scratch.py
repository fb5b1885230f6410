"""One scratch folder per process; the next command deletes those of killed processes."""

from __future__ import annotations

import atexit
import logging
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def own_scratch() -> Iterator[None]:
    """Put this process's temporary files into a folder of its own for as long as the context lasts.

    This includes files of libraries. If no temporary folder can be written to, nothing is changed: a later
    write reports the error.
    """
    from flexspline.pipeline.temporary_files import discard, mark
    from flexspline.results.job import tell

    # where a user's home cannot be written to, it takes a folder of ours and says so in two lines
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    before = tempfile.tempdir
    try:
        parent = Path(tempfile.gettempdir())
        discard(parent, tell)
        folder = tempfile.mkdtemp(prefix=mark(), dir=parent)
    except OSError:
        yield
        return
    # at the very end: libraries that come later clear what they put there before
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    tempfile.tempdir = folder
    try:
        yield
    finally:
        tempfile.tempdir = before
