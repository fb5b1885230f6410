"""A ratio printed as percent: a number, a space, the sign."""

from __future__ import annotations


def percent(share: float, digits: int = 2) -> str:
    """In per cent, with so many significant digits.

    >>> percent(0.0026), percent(0.5), percent(1.234)
    ('0.26 %', '50 %', '120 %')
    """
    return f"{float(f'{100 * share:.{digits}g}'):g} %"


def percent_of_all(share: float) -> str:
    """Whole, but never rounded up to all.

    >>> percent_of_all(0.976), percent_of_all(0.9997), percent_of_all(1.0)
    ('98 %', '99.9 %', '100 %')
    """
    if share >= 1:
        return "100 %"
    return f"{int(1000 * share) / 10:.1f} %" if share > 0.99 else f"{100 * share:.0f} %"


def percent_change(share: float) -> str:
    """With its sign, a true minus, to the tenth; of what would be 0.0, that it is less.

    >>> percent_change(0.0123), percent_change(-0.0004)
    ('+1.2 %', 'less than 0.05 %')
    """
    if abs(share) < 0.0005:
        return "less than 0.05 %"
    return f"{100 * share:+.1f} %".replace("-", "\N{MINUS SIGN}")
