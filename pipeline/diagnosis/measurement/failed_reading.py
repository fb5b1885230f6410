"""What programs and instruments write for a reading that failed."""

from __future__ import annotations

import re

_WORDS = {
    "nan", "inf", "infinity", "null", "none", "na", "n/a", "n.a.", "err", "error", "invalid", "fail",
    "failed", "fault", "ol", "o.l", "ovl", "ovf", "ovld", "ovrflw", "overload", "overflow", "overrange",
    "over range", "underflow", "underrange", "over", "under", "open", "missing", "fehler", "überlauf",
    "überlast", "ungültig",
}  # fmt: skip
SHEET_ERROR = re.compile(
    r"#(?:N/A|NV|VALUE!|WERT!|HODNOTA!|DIV/0!|D[ĚE]LENÍ_NULOU!|REF!|BEZUG!|NUM!|ZAHL!|NAME\?|NULL!)",
    re.IGNORECASE,
)
"""A spreadsheet's, in English, German or Czech; Japanese and Chinese programs write the English ones."""
_NO_NUMBER = re.compile(r"1\.#(?:INF|IND|QNAN|SNAN)0*|9\.9(?:0*|10*)E\+?37", re.IGNORECASE)
"""Of old C programs on Windows; SCPI instruments' infinity, 9.9E37, and "not a number", 9.91E37."""
_DASHES = re.compile(r"[-–—*_?.]*")


def is_failed(text: str) -> bool:
    """Whether a cell's text, without blanks at its ends, says that there is no reading; an empty one does.

    >>> [is_failed(t) for t in ("", "---", "#N/A", "-OVLD", "0", "-1.5", "no")]
    [True, True, True, True, False, False, False]
    """
    if _DASHES.fullmatch(text):
        return True
    if text[-1].isdigit() and "37" not in text and "#" not in text:  # most cells, at once
        return False
    bare = text.lstrip("+-").rstrip(".!").replace(",", ".").lower()
    return bool(
        bare in _WORDS or SHEET_ERROR.fullmatch(text) or _NO_NUMBER.fullmatch(bare.split("(")[0])
        or bare.split("(")[0] == "nan"
    )  # fmt: skip
