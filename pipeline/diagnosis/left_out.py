"""Rows that were left out of a fit to measure its error there, as facts without words."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LeftOut:
    """Rows left out together, described by their values of a channel.

    Attributes
    ----------
    channel : of a record, or "specimen".
    values : of those left out; of a whole `level` its least and its largest; none where `each` of so many was
        left out in turn, or where they have names.
    names : of the units left out.
    of_units : of cycles that units number differently, in place of `values`: each unit's name and numbers.
    """

    channel: str
    values: tuple[float, ...] = ()
    level: bool = False
    each: int = 0
    names: tuple[str, ...] = ()
    of_units: tuple[tuple[str, tuple[float, ...]], ...] = ()
