"""A ratio printed as percent: a number, a space, the sign."""

from __future__ import annotations


def percent(share: float, digits: int = 2) -> str:
    """In per cent, with so many significant digits.

    >>> percent(0.0026), percent(0.5), percent(1.234)
    ('0.26 %', '50 %', '120 %')
    """
    return f"{float(f'{100 * share:.{digits}g}'):g} %"
