"""Designs of a study that could not be built or solved: number by cause, with one example."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.result import StudyResult

LISTED_REASONS = 8
"""Causes that a report or the terminal lists, the commonest first."""
_NUMBER = re.compile(r"\d[\d.]*(e[+-]?\d+)?")


@dataclass(frozen=True)
class FailureReason:
    """What keeps designs from being built or solved.

    Attributes
    ----------
    name : the key of the design file that cannot be what it is, or what failed, its numbers left out.
    designs : how many have this fault; a design may have several.
    example : the first of them.
    fault : the example's, with its numbers.
    """

    name: str
    designs: int
    example: Row
    fault: str

    @property
    def example_words(self) -> str:
        """The example in words, beside the cause's name."""
        design, key = f"design {self.example.slot}", f"{self.name} = "
        if self.fault.startswith(key):
            return f"{design} has {self.fault.removeprefix(key)}"
        return f"{design}: {self.fault}"


def causes(result: StudyResult) -> list[FailureReason]:
    """Of all missing figures, the commonest first."""
    by_cause: dict[str, dict[int, tuple[Row, str]]] = {}
    for row in result.rows:
        for fault in row.outcome.faults:
            by_cause.setdefault(_cause(fault), {}).setdefault(row.slot, (row, fault))
    reasons = [
        FailureReason(name, len(designs), *next(iter(designs.values())))
        for name, designs in by_cause.items()
    ]
    return sorted(reasons, key=lambda cause: -cause.designs)


def _cause(fault: str) -> str:
    """The key at fault, whatever its value; of other faults the words."""
    key, equals, _ = fault.partition(" = ")
    if equals and " " not in key:
        return key
    return without_numbers(fault)


def without_numbers(text: str) -> str:
    """What two designs have in common where they differ in their numbers alone."""
    return _NUMBER.sub("…", text)


def failure_lines(result: StudyResult) -> Iterator[str]:
    """For the terminal."""
    reasons = causes(result)
    if not reasons:
        return
    count = sum(bool(row.outcome.faults) for row in result.rows)
    yield (
        f"{count} of {len(result.rows)} designs could not be built or not be solved completely; causes (a "
        "design may have several):"
    )
    for cause in reasons[:LISTED_REASONS]:
        yield f"  {cause.designs} × {cause.name}: {cause.example_words}"
    if more := further_reasons(reasons):
        yield f"  {more}"


def contradiction(result: StudyResult) -> str:
    """Where two models of a design contradict each other: how many such designs, and the first; else ""."""
    contradicted = {r.slot: r.outcome.reason for r in result.rows if r.outcome.contradicted}
    contradicted |= {v.slot: v.reason for v in result.verified if v.contradicted}
    if not contradicted:
        return ""
    slot, reason = next(iter(contradicted.items()))
    count = f"{len(contradicted)} of {len(result.rows)} designs"
    return f"two models contradict each other in {count}; design {slot}: {reason}"


def nothing_built(result: StudyResult) -> str:
    """Where no design has the figures asked for: the most frequent cause; "" where one has."""
    if result.built or not result.rows:
        return ""
    sentence = f"none of {len(result.rows)} designs could be built and solved"
    reasons = causes(result)
    if not reasons:
        return sentence
    first = reasons[0]
    return (
        f"{sentence}; most frequent cause ({first.designs} ×): {first.name}: {first.example_words}"
    )


def further_reasons(reasons: list[FailureReason]) -> str:
    """Of causes beyond those that are listed."""
    left = len(reasons) - LISTED_REASONS
    if left <= 0:
        return ""
    return f"and {left} more cause{'s' * (left > 1)} (column reason of study.csv)"
