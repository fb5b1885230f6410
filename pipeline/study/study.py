"""A study that was read and checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.keys import location_of, value_at
from flexspline.geometry.schema import ends_of, node_at
from flexspline.pipeline.study.figures import TOTAL, USUAL_FIGURES
from flexspline.pipeline.study.schema import StudyFile


class StudyError(DesignError):
    """A study file that cannot be accepted: key, value, and what would work."""


@dataclass(frozen=True)
class Study:
    """A study that was read and checked, and the design that it varies."""

    name: str
    file: StudyFile
    design: Design

    @cached_property
    def whole(self) -> frozenset[str]:
        """Keys that hold whole numbers."""
        kind = self.design.flexspline.kind
        nodes = {key: node_at(location_of(key), kind) for key in self.file.vary}
        return frozenset(key for key, node in nodes.items() if node["type"] == "integer")

    def range_of(self, key: str) -> tuple[float, float]:
        """Least and largest value that a design file may have at a key of a number."""
        least, *_, most = ends_of(location_of(key), self.design.flexspline.kind)
        return least, most

    @property
    def keys(self) -> tuple[str, ...]:
        """The design keys whose values change from design to design."""
        return (*self.file.vary, *self.file.link, *self.file.tolerance)

    @property
    def start_values(self) -> dict[str, float]:
        """Values of the varied keys in the first design, where it states them."""
        values = {key: value_at(self.design, key) for key in self.file.vary}
        return {key: value for key, value in values.items() if value is not None}

    @property
    def asked(self) -> frozenset[str]:
        """The figures that a design must have: objectives and constraints, else the usual ones."""
        if self.file.run.method == "tolerance":
            return frozenset(self.outputs)
        return frozenset({**self.file.objective, **self.file.constraint} or USUAL_FIGURES)

    @property
    def outputs(self) -> tuple[str, ...]:
        """The figures whose scatter a tolerance study tells: the objectives, or the backlash."""
        return tuple(self.file.objective) or (TOTAL,)

    def is_answered(self, figures: Mapping[str, float]) -> bool:
        """Whether a design has every figure asked for; what else could not be solved costs only itself."""
        return self.asked <= figures.keys()

    def excesses(self, figures: Mapping[str, float]) -> list[float]:
        """Return how far each constraint is overstepped, over its limit's size; at most 0 where it holds.

        A constraint on a figure that is missing counts as overstepped by all of its limit.
        """
        return [
            limit.excess(figures[k]) / limit.size if k in figures else 1.0
            for k, limit in self.file.constraint.items()
        ]
