"""What a recording program writes below its last row: "End of record", a name, a remark."""

from __future__ import annotations

import re
from collections.abc import Sequence
from enum import Enum, auto

from flexspline.pipeline.diagnosis.measurement.column_names import LABELS
from flexspline.pipeline.diagnosis.measurement.failed_reading import is_failed
from flexspline.pipeline.diagnosis.measurement.time_stamps import is_stamp

_WORD = re.compile(r"[^\W\d_]{2}")
_LETTER = re.compile(r"[^\W\d_]")
_BEGINS_WITH_NUMBER = re.compile(r"[\W_]*\d")
"""Also "12.3 Nm", "> 5" and "(2024)": the first letter or digit is a digit."""
_PHRASE = re.compile(r"[^\W\d_]\W*\s+\W*[^\W\d_]")
"""Two words: no program writes them for one reading that failed."""


class _CellKind(Enum):
    """What one text of a row may be."""

    WORDS = auto()
    NUMBER = auto()
    NEITHER = auto()


def rows_above_footer(head: Sequence[str], rows: Sequence[Sequence[str]]) -> int:
    """How many rows are left where lines of words at the end are none."""
    count = len(rows)
    while count > 1 and _is_remark(head, rows[count - 1], rows[:count]):
        count -= 1
    return count


def _is_remark(head: Sequence[str], row: Sequence[str], rows: Sequence[Sequence[str]]) -> bool:
    """Whether a row is words; what may be a reading is none, and is checked as one.

    The separator may stand in the words, and parts them into cells. A number among them is the words' own
    ("measured by Smith, 2024") where it is parted from them as prose is, by a blank that the rows do not
    have, or follows a phrase in a row that is not full.
    """
    at = [i for i, cell in enumerate(row) if cell.strip()]
    kinds = [_kind(row[i].strip()) for i in at]
    first = row[at[0]].strip()
    if len(head) < 2 or kinds[0] is not _CellKind.WORDS or _WORD.search(first) is None:
        return False
    if _CellKind.NEITHER in kinds:
        return False
    if head[0] in LABELS and len(row) > 1:
        known = {r[0].strip() for r in rows[:-1]}
        return len(at) > 1 and _CellKind.NUMBER not in kinds and first not in known
    numbers = kinds.count(_CellKind.NUMBER)
    if not numbers:
        return True
    spaced = all(row[i][0].isspace() for i in at[1:]) and not any(
        cell[:1].isspace() for cell in rows[0][1:]
    )
    columns = sum(bool(name.strip()) for name in head)
    cut_off = _PHRASE.search(first) is not None and len(at) < columns
    return 2 * numbers <= len(kinds) and (spaced or cut_off)


def _kind(text: str) -> _CellKind:
    if is_stamp(text) or _BEGINS_WITH_NUMBER.match(text):
        return _CellKind.NUMBER
    if is_failed(text) or not _LETTER.search(text):
        return _CellKind.NEITHER
    return _CellKind.WORDS
