"""Keeps a fuller earlier result if a command with fewer figures (`backlash`) writes to the same folder."""

from __future__ import annotations

import json
from pathlib import Path

from flexspline.results.atomic import write_together
from flexspline.results.file_names import PREVIOUS, RESULT
from flexspline.results.records import Record, as_json

NO_FIGURES = {"pictures_missing"}
"""A key whose absence is good news."""
MOST_NAMED = 3
"""Figures that the note names."""


def write_result(folder: Path, record: Record) -> str | None:
    """Write result.json; where it lacks figures of the one that is there, keep that one beside it.

    The earlier one is kept until an answer has all its figures again.

    Returns
    -------
    str | None : the note, where the earlier one has just been kept.

    Raises
    ------
    OSError : with the path's name; what was there before still is.
    """
    earlier, previous = (_figures(folder / name) for name in (RESULT, PREVIOUS))
    lacking = [key for key in earlier if key not in record]
    files = {RESULT: (as_json(record) + "\n").encode()}
    moved = bool(lacking) and not earlier.keys() <= previous.keys()
    if moved:
        files[PREVIOUS] = (folder / RESULT).read_bytes()
    write_together(folder, files)
    if moved:
        more = f" and {len(lacking) - MOST_NAMED} more" if len(lacking) > MOST_NAMED else ""
        names = ", ".join(lacking[:MOST_NAMED])
        return (
            f"the earlier {RESULT} has figures that this command does not compute"
            f" ({names}{more}); it is kept as {PREVIOUS}"
        )
    if previous and previous.keys() <= record.keys():
        (folder / PREVIOUS).unlink(missing_ok=True)
    return None


def _figures(path: Path) -> Record:
    """Of a record; none where the file is missing or no record."""
    try:
        record = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return {}
    return (
        {k: v for k, v in record.items() if k not in NO_FIGURES} if isinstance(record, dict) else {}
    )
