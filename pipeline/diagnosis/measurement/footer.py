"""What a recording program writes below its last row: "End of record", a name, a remark."""

from __future__ import annotations

import re
from collections.abc import Sequence

from flexspline.pipeline.diagnosis.measurement.column_names import LABELS
from flexspline.pipeline.diagnosis.measurement.number_text import number_of
from flexspline.pipeline.diagnosis.measurement.time_stamps import is_stamp

_WORD = re.compile(r"[^\W\d_]{2}")
_NO_VALUE = {"nan", "inf", "infinity", "null", "none"}
"""Of a reading that failed, not of a remark."""


def rows_above_footer(head: Sequence[str], rows: Sequence[Sequence[str]]) -> int:
    """How many rows are left where lines of words at the end are none.

    Such a line holds one text, in front, and no number: whatever else stands in a row is a reading, and is
    checked as one. So is a text below a column of labels.
    """
    count = len(rows)
    while count > 1 and _is_remark(head, rows[count - 1]):
        count -= 1
    return count


def _is_remark(head: Sequence[str], row: Sequence[str]) -> bool:
    first, *others = (cell.strip() for cell in row)
    if any(others) or len(head) < 2 or (head[0] in LABELS and len(row) > 1):
        return False
    if first.lstrip("+-").lower() in _NO_VALUE or is_stamp(first):
        return False
    no_number = number_of(first, ".") is None and number_of(first, ",") is None
    return no_number and _WORD.search(first) is not None
