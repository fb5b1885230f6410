"""How numbers are printed: groups of three, true minus sign, powers of ten."""

from __future__ import annotations

from math import floor, log10

from flexspline.geometry.bounds import MOST_DIGITS

THIN = "\N{NARROW NO-BREAK SPACE}"
"""Between groups of three digits, and between a number and its unit."""


def grouped(value: float, decimals: int) -> str:
    """Fixed decimals, true minus sign, groups of three from five digits before the point on."""
    text = f"{abs(value):,.{decimals}f}"
    whole, point, rest = text.partition(".")
    whole = whole.replace(",", THIN if len(whole) > len("9,999") else "")
    negative = value < 0 and float(f"{abs(value):.{decimals}f}") > 0
    return ("\N{MINUS SIGN}" if negative else "") + whole + point + rest


def signed(value: float, decimals: int = 2) -> str:
    """With its sign, a true minus."""
    return f"{value:+z.{decimals}f}".replace("-", "\N{MINUS SIGN}")


def beyond(value: float, limit: float, digits: int = 2) -> str:
    """A value that passes a limit, with as many significant digits as show it.

    >>> beyond(0.503, 0.5), beyond(0.7, 0.5)
    ('0.503', '0.7')
    """
    text = f"{value:.{digits}g}"
    while float(text) <= limit < value and digits < MOST_DIGITS:
        digits += 1
        text = f"{value:.{digits}g}"
    return text


def with_power(value: float, digits: int = 1) -> str:
    """So many significant digits and a power of ten: ``3·10⁻⁶``; ``0`` is 0."""
    if not value:
        return "0"
    digit, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{digit}·10{str(int(exponent)).translate(_RAISED)}".replace("-", "\N{MINUS SIGN}")


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def round_number(most: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not above `most`, but for rounding."""
    decade = 10.0 ** floor(log10(most))
    return float(f"{max(s * decade for s in (1.0, 2.0, 5.0) if s * decade <= 1.0001 * most):.1g}")


def decimals_for(value: float, digits: int) -> int:
    """Decimals that show so many significant digits."""
    if value == 0:
        return 0
    return max(0, digits - 1 - floor(log10(abs(value))))


def figures_text(value: float, digits: int = 3) -> str:
    """A number with so many significant digits."""
    return grouped(value, decimals_for(value, digits))
