"""Full-width characters of Chinese and Japanese keyboards, and their ASCII equivalents."""

from __future__ import annotations

FIRST_SIGN, LAST_SIGN = 0x21, 0x7E
"""The first and last sign of ASCII that has a wide one, "!" and "~"."""
FARTHER = 0xFEE0
"""From a sign of ASCII to its wide one, in Unicode's block "Halfwidth and Fullwidth Forms"."""
_NARROW = {n + FARTHER: chr(n) for n in range(FIRST_SIGN, LAST_SIGN + 1)} | str.maketrans(
    "。“”\u3000", '."" '
)


def narrow(text: str) -> str:
    """The text with ASCII's signs in place of the wide ones, the ideographic space and curved quotes too."""
    return text.translate(_NARROW)
