"""The known key that is most similar to a misspelt key."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

LONGEST = 200
"""Letters of a key that are compared: a file may hold one of thousands, and difflib's time grows with their
square."""
LEAST_SIMILARITY = 0.6
"""The least of difflib's ratio, from 0 (nothing in common) to 1 (equal): its default."""


def nearest_key(key: str, known: Iterable[str]) -> str | None:
    """That of the known keys which is most like `key`; None where none is much like it.

    Examples
    --------
    >>> nearest_key("modul_mm", ["module_mm", "teeth_flexspline"])
    'module_mm'
    >>> nearest_key("flexspline.wall_mm", ["flexspline.length_mm", "flexspline.wall_thickness_mm"])
    'flexspline.wall_thickness_mm'
    """
    known = list(known)
    words, _, unit = key.rpartition("_")
    if (
        words
        and len(whole := [k for k in known if k.startswith(f"{words}_") and k.endswith(unit)]) == 1
    ):
        return whole[0]  # a word is missing
    closest = get_close_matches(key[:LONGEST], known, n=1, cutoff=LEAST_SIMILARITY)
    return closest[0] if closest else None
