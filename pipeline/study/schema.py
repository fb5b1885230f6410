"""The study file's schema: immutable, strict; with the checks of single keys."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field
from pydantic.fields import FieldInfo

Method = Literal["grid", "sobol", "optimize", "tolerance"]
MOST_EVALUATIONS = 1_000_000
LARGEST_NUMBER = 1e18
"""No figure of a gear comes near: stiffness ends at 1e15 N·m/rad. Squares stay within a double."""
Number = Annotated[float, Field(ge=-LARGEST_NUMBER, le=LARGEST_NUMBER, allow_inf_nan=False)]


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class VariedSpan(_Frozen):
    """A design key that a study varies: between two ends, or over listed values."""

    min: Number | None = None
    max: Number | None = None
    steps: int | None = Field(default=None, ge=2, le=10_000, description="of a grid, ends included")
    values: Annotated[tuple[Number, ...] | None, Field(min_length=1, max_length=10_000)] = Field(
        default=None, strict=False
    )

    @property
    def ends(self) -> tuple[float, float]:
        """Least and largest value; the loader has seen that they are there."""
        if self.values is not None:
            return min(self.values), max(self.values)
        if self.min is None or self.max is None:
            raise LookupError("a span without ends was not refused")
        return self.min, self.max


class Link(_Frozen):
    """A design key that follows another: times · value + plus."""

    of: str
    times: Number = 1.0
    plus: Number = 0.0


class Limit(_Frozen):
    """Limits of a figure, either end included."""

    min: Number | None = None
    max: Number | None = None

    @property
    def size(self) -> float:
        """Size of the limits, with which an excess is compared."""
        size = max(abs(x) for x in (self.min, self.max) if x is not None)
        return size if size > 1 / LARGEST_NUMBER else 1.0

    def ends(self, low: float, high: float) -> tuple[float, float]:
        """Its ends, those given where it has none."""
        return (
            low if self.min is None else float(self.min),
            high if self.max is None else float(self.max),
        )

    def excess(self, value: float) -> float:
        """Return how far a value is outside, at most 0 inside; in the figure's unit."""
        over = [value - self.max] if self.max is not None else []
        under = [self.min - value] if self.min is not None else []
        return max([*over, *under])


class Spread(_Frozen):
    """Scatter of a number: uniform within ± `plus_minus`, or normal with `std`."""

    plus_minus: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = None
    std: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = None


class Run(_Frozen):
    """How a study is carried out."""

    method: Method = "sobol"
    evaluations: int = Field(default=100, ge=1, le=MOST_EVALUATIONS)
    seed: int = Field(default=1, ge=0, le=2**31 - 1)
    workers: int = Field(default=2, ge=1, le=256, description="local processes")
    scheduler: str = Field(default="", max_length=500, description="a Dask scheduler's address")
    storage: str = Field(default="", max_length=500, description="database URL; study.db if empty")
    verify: int = Field(default=0, ge=0, le=100, description="designs solved again, solid model")


class StudyFile(_Frozen):
    """A study as written."""

    design: str = Field(min_length=1, max_length=1000)
    vary: dict[str, VariedSpan] = {}
    link: dict[str, Link] = {}
    tolerance: dict[str, Spread] = {}
    objective: dict[str, Literal["minimize", "maximize"]] = {}
    constraint: dict[str, Limit] = {}
    run: Run = Run()


def _whole(field: FieldInfo) -> str:
    """What a field of a whole number takes, in words; pydantic keeps its limits as Ge and Le."""
    least, most = field.metadata
    return f"a whole number from {least.ge} to {most.le}"


NUMBER_WORDS = f"from {-LARGEST_NUMBER:g} to {LARGEST_NUMBER:g}"
WORDS: dict[str, str] = {
    "design": 'the path of a design file, e.g. "xb1-40.toml"',
    "vary": "a table [vary] of design keys",
    "vary.*": "{ min = …, max = … } or { values = […] }",
    "vary.*.min": "a number below max",
    "vary.*.max": "a number above min",
    "vary.*.steps": _whole(VariedSpan.model_fields["steps"]),
    "vary.*.values": "a list of 1 to 10000 numbers",
    "link": "a table [link] of design keys",
    "link.*": '{ of = "design key", times = 1.0, plus = 0.0 }',
    "link.*.of": "a design key",
    "link.*.times": f"a number {NUMBER_WORDS}",
    "link.*.plus": f"a number {NUMBER_WORDS}",
    "tolerance": "a table [tolerance] of design keys",
    "tolerance.*": "{ plus_minus = … } or { std = … }",
    "tolerance.*.plus_minus": "a number above 0",
    "tolerance.*.std": "a number above 0",
    "objective": "a table [objective] of figures",
    "objective.*": '"minimize" or "maximize"',
    "constraint": "a table [constraint] of figures",
    "constraint.*": "{ min = … }, { max = … } or both",
    "constraint.*.min": f"a number {NUMBER_WORDS}",
    "constraint.*.max": f"a number {NUMBER_WORDS}",
    "run": "a table [run]",
    "run.method": '"grid", "sobol", "optimize" or "tolerance"',
    "run.evaluations": _whole(Run.model_fields["evaluations"]),
    "run.seed": _whole(Run.model_fields["seed"]),
    "run.workers": _whole(Run.model_fields["workers"]),
    "run.scheduler": 'the address of a Dask scheduler, e.g. "tcp://host:8786", or ""',
    "run.storage": 'a database URL, e.g. "sqlite:///study.db", or ""',
    "run.verify": _whole(Run.model_fields["verify"]),
}
"""What every key may hold, in words; `*` is a design key or a figure."""

KEYS: dict[str, tuple[str, ...]] = {
    "": tuple(StudyFile.model_fields),
    "vary.*": tuple(VariedSpan.model_fields),
    "link.*": tuple(Link.model_fields),
    "tolerance.*": tuple(Spread.model_fields),
    "constraint.*": tuple(Limit.model_fields),
    "run": tuple(Run.model_fields),
}
"""Keys that each table takes."""


def pattern(location: tuple[Any, ...]) -> str:
    """Return a location of pydantic's as a key of WORDS: ("vary", "a.b", "min") → "vary.*.min"."""
    parts = [str(p) for p in location if not isinstance(p, int)]
    if len(parts) > 1 and parts[0] != "run":
        parts[1] = "*"
    return ".".join(parts[:3])
