"""Errors of the geometry room: each carries the numbers that explain it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from unicodedata import category

_UNREAD = re.compile("[\udc80-\udcff]+")
MISSING = object()
"""The value of a key that is not there."""
ARTEFACT = 14
"""Letters of a float: longer ones, such as 0.30000000000000004, are rounding and not what a person wrote."""
LONGEST_VALUE = 60
"""Letters of a value that an error message repeats, at most."""
FIXED = range(-6, 7)
"""Powers of ten that are written out; beyond, zeros have to be counted."""


def _restored(
    kind: type[FlexsplineError], args: tuple[object, ...], state: dict[str, object]
) -> FlexsplineError:
    fault = kind.__new__(kind, *args)
    fault.__dict__.update(state)
    return fault


class FlexsplineError(Exception):
    """The base of every error that the program raises on purpose; its text is one line.

    Examples
    --------
    >>> from flexspline import FlexsplineError, load_design
    >>> try:
    ...     load_design("no-such-design.toml")
    ... except FlexsplineError as fault:
    ...     print(fault)
    no-such-design.toml: no such file
    """

    def __reduce__(self) -> tuple[object, ...]:
        """As it is, whatever its own `__init__` takes: workers raise it in another process."""
        return _restored, (type(self), self.args, self.__dict__)


LISTED_FAULTS = 5
"""Further faults whose keys a message names: it stays one line of a terminal or two."""


class DesignError(FlexsplineError, ValueError):
    """A design that cannot be accepted: which key, its value, and what would work.

    The message is one printable line, whatever the value holds.

    Attributes
    ----------
    key : dotted key of the design file, e.g. ``flexspline.wall_thickness_mm``.
    value : what was found there; `MISSING` if nothing.
    reason : one clause that names the workable range, with its numbers.
    others : the design's further faults: one is said too, more are counted and their keys named.
    """

    def __init__(
        self, key: str, value: object, reason: str, others: Sequence[DesignError] = ()
    ) -> None:
        self.key, self.value, self.reason, self.others = key, value, reason, tuple(others)
        also = f"; and {others[0]}" if others else ""
        if len(others) > 1:
            keys = ", ".join(one_line(fault.key) for fault in others[:LISTED_FAULTS])
            also = (
                f" (and {len(others)} more faults: {keys}{', …' * (len(others) > LISTED_FAULTS)})"
            )
        super().__init__(f"{self.alone}{also}")

    @property
    def alone(self) -> str:
        """This fault without the others."""
        given = "is missing" if self.value is MISSING else f"= {short(self.value)}"
        return f"{one_line(self.key)} {given}: {one_line(self.reason)}"


class DesignFileError(DesignError):
    """A design file that cannot be read at all; `path` and why."""

    def __init__(self, path: object, reason: str) -> None:
        super().__init__(str(path), None, reason)
        self.path = path
        self.args = (f"{one_line(str(path))}: {one_line(reason)}",)


class ComputationError(FlexsplineError, RuntimeError):
    """A computation failed for a stated reason; the base of every such error of every room."""


class GeometryError(ComputationError):
    """The CAD kernel did not produce the solid that the design describes."""


def short(value: object) -> str:
    """A value as one short printable line."""
    if isinstance(value, bool):
        text = str(value).lower()  # as TOML writes it
    elif isinstance(value, int) and abs(value) >= 10**LONGEST_VALUE:
        text = f"a whole number of more than {LONGEST_VALUE} digits"  # str() refuses thousands of digits
    elif isinstance(value, dict):
        text = "{a table}"
    elif isinstance(value, list | tuple):
        text = f"[a list of {len(value)}]"
    elif isinstance(value, str):
        text = f'"{value[: LONGEST_VALUE + 1]}"'
    else:
        text = str(value)
        if isinstance(value, float) and ("e" in text or len(text) > ARTEFACT):
            text = plain_number(value)
    return one_line(text, LONGEST_VALUE)


def plain_number(value: float, digits: int = 12) -> str:
    """A number as a person writes it: 0.3, not 0.30000000000000004; 0.00001, not 1e-05.

    Examples
    --------
    >>> plain_number(0.1 + 0.2), plain_number(1e-5), plain_number(2e-9), plain_number(1e6, 6)
    ('0.3', '0.00001', '2e-9', '1000000')
    """
    text = f"{value:.{digits}g}"
    if "e" not in text:
        return text
    mantissa, _, exponent = text.partition("e")
    power = int(exponent)
    if FIXED.start <= power < FIXED.stop:
        text = f"{value:.{max(0, digits - 1 - power)}f}"
        return text.rstrip("0").rstrip(".") if "." in text else text
    return f"{mantissa}e{power}"


def readable(text: str) -> str:
    """Text that UTF-8 can hold: the bytes of a file's name that the locale could not read, read as UTF-8."""
    return _UNREAD.sub(
        lambda match: match[0].encode("utf-8", "surrogateescape").decode("utf-8", "replace"), text
    )


def why_of(fault: OSError, where: str = "") -> str:
    """`fault` by its file's name, or `where` it has none, and the system's own words."""
    return f"{f'{fault.filename}: ' if fault.filename else where}{fault.strerror or fault}"


def one_line(text: str, limit: int = 600) -> str:
    """Printable text on one line: control characters are written as escapes."""
    text = readable(text[: limit + 1])
    text = "".join(c if _is_shown(c) else c.encode("unicode_escape").decode() for c in text)
    return text if len(text) <= limit else text[: limit - 1] + "…"


def _is_shown(letter: str) -> bool:
    """Whether it needs no escape: Python counts no space but the plain one as printable."""
    return letter.isprintable() or category(letter) == "Zs"
