"""The text of docs/validation.md: rows of case, source, expected, got, difference under topics."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

TOPICS = {
    "The backlash sum": ("test_source_article",),
    "Torsion of bodies of revolution, between two bounds": ("test_axisymmetric_torsion",),
    "Fourier harmonics on the meridian": (
        "test_axisymmetric_harmonics",
        "test_axisymmetric_against_solid",
        "test_peak_on_the_ellipse",
    ),
    "The rim on the wave generator": (
        "test_contact_on_the_seat",
        "test_free_rim_with_holes",
        "test_seat_width",
    ),
    "Stress on the meridian": (
        "test_axisymmetric_stress",
        "test_stress_rule",
        "test_peak_under_torque",
    ),
    "The toothed ring": ("test_toothed_ring",),
    "Solid elements against closed forms": ("test_solid_closed_forms",),
    "Solid elements on published benchmarks": (
        "test_nafems_le1",
        "test_nafems_le10",
        "test_scordelis_lo",
        "test_pinched_cylinder",
    ),
    "Solid models against the two-sided bounds": ("test_solid_against_axisymmetric",),
    "Bolt holes between two bodies of revolution": (
        "test_enclosed_holes",
        "test_lobes_by_torsion",
        "test_lift_off_against_drawn_holes",
    ),
    "Bolt holes, what they change solved alone": ("test_superposition",),
    "Honesty of the solid model's error estimate": ("test_estimate_honesty",),
}
"""Headings in the page's order, and the test modules under each."""

ROUNDING = 1e-9

HEAD = """\
# Validation

Written by `python3 -m pytest tests/verification --write-validation` from what the tests found, those
that take minutes too; edit the tests, not this page. Every row is asserted in the test file named
above its table, where the tolerance and its reason stand. “Expected” is the source's figure, or the
range it allows; where the two differ by more than a percent, the test says why. Parts meshed by
fTetWild get a slightly different mesh each time: their last digit may change.
"""


@dataclass(frozen=True)
class Row:
    """One case. `expected` is a number, or (low, high) where the source gives a range."""

    module: str
    case: str
    source: str
    expected: float | tuple[float, float]
    got: float
    unit: str = ""
    digits: int = 4

    def figure(self, x: float) -> str:
        """A number in print; what is only rounding is 0, or it would differ between machines."""
        if abs(x) < ROUNDING:
            return "0"
        text = f"{x:.{self.digits}g}"
        if "e" in text and abs(x) >= 1:  # 3.134e+04: thousands read better in full
            text = f"{float(text):.0f}"
        return text.replace("-", "−")

    @property
    def wanted(self) -> str:
        if not isinstance(self.expected, tuple):
            return self.figure(self.expected)
        low, high = self.expected
        if high == inf:
            return f"≥ {self.figure(low)}"
        if low == -inf:
            return f"≤ {self.figure(high)}"
        return f"{self.figure(low)} to {self.figure(high)}"

    @property
    def difference(self) -> str:
        if isinstance(self.expected, tuple):
            low, high = self.expected
            return "within" if low <= self.got <= high else "outside"
        if self.expected == 0:
            return "rounding" if abs(self.got) < ROUNDING else self.figure(self.got)
        percent = 100 * (self.got / self.expected - 1)
        if abs(percent) < 0.005:
            return "< 0.01 %"
        return f"{percent:+.2f} %".replace("-", "−")

    @property
    def start(self) -> str:
        return f"| {self.case} | {self.source} |"

    def line(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.start} {self.wanted}{unit} | {self.figure(self.got)}{unit} | {self.difference} |"


def topic_of(module: str) -> str:
    """The heading of a test module."""
    for topic, modules in TOPICS.items():
        if module in modules:
            return topic
    raise ValueError(f"{module} has no heading in TOPICS")


def markdown(rows: list[Row]) -> str:
    """The whole page.

    Raises
    ------
    ValueError : a row's module has no topic, or two rows under one topic are the same case.
    """
    starts = [(topic_of(row.module), row.start) for row in rows]
    if twice := {s for s in starts if starts.count(s) > 1}:
        raise ValueError(f"recorded twice: {sorted(twice)}")
    parts = [HEAD]
    for topic, modules in TOPICS.items():
        lines = [row.line() for m in modules for row in rows if row.module == m]
        files = ", ".join(f"[`{m}`](../tests/verification/{m}.py)" for m in modules)
        table = ["| case | source | expected | got | difference |", "|---|---|---|---|---|", *lines]
        parts.append(f"## {topic}\n\n{files}\n\n" + "\n".join(table) + "\n")
    return "\n".join(parts)


def has_case(page: str, row: Row) -> bool:
    """Whether the page has the row's case under its heading, whatever the figures."""
    section = page.partition(f"## {topic_of(row.module)}\n")[2].partition("\n## ")[0]
    return any(line.startswith(row.start) for line in section.splitlines())
