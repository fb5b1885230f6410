"""Results of a study: its rows, the designs that meet the constraints, the best designs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.geometry.design import Design
from flexspline.geometry.keys import with_values
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome
from flexspline.pipeline.study.figures import USUAL_FIGURES
from flexspline.pipeline.study.plan import linked
from flexspline.pipeline.study.scatter import Scatter
from flexspline.pipeline.study.study import Study
from flexspline.pipeline.study.verified import Verified


@dataclass(frozen=True)
class StudyResult:
    """All rows by slot, and the order of the best."""

    study: Study
    rows: tuple[Row, ...]
    scatter: tuple[Scatter, ...] = ()
    """Of a tolerance study, by figure."""
    unscattered: str = ""
    """Why a tolerance study tells nothing of its figures."""
    verified: tuple[Verified, ...] = ()
    """Of the best designs, by rank."""
    no_holes_effect: str = ""
    """Why it is not known what the shaft's holes and keyway do to K_e."""
    start: Outcome | None = None
    """Of the design that the study began with; None where no design is best."""

    @property
    def about_scatter(self) -> bool:
        """Whether its designs are one gear's scatter, none better than another."""
        return self.study.file.run.method == "tolerance"

    def design_of(self, row: Row) -> Design:
        """Return the whole design of a row."""
        return with_values(self.study.design, linked(self.study, row.values))

    @property
    def shown(self) -> tuple[str, ...]:
        """Figures to look at: the objectives, or where there are none the usual ones."""
        wanted = tuple(self.study.file.objective) or USUAL_FIGURES
        return tuple(k for k in wanted if all(k in r.outcome.figures for r in self.built))

    @property
    def nearest(self) -> Row | None:
        """Return the row that oversteps the constraints least, by shares of their limits."""

        def overstep(row: Row) -> float:
            return sum(max(0.0, e) for e in self.study.excesses(row.outcome.figures))

        return min(self.built, key=overstep, default=None)

    @property
    def built(self) -> tuple[Row, ...]:
        """Rows with every figure that the study asks for (`Study.is_answered`)."""
        return tuple(r for r in self.rows if self.study.is_answered(r.outcome.figures))

    @property
    def incomplete(self) -> tuple[Row, ...]:
        """Of those built, the rows that lack a figure which nothing asks for; `reason` says why."""
        return tuple(r for r in self.built if r.outcome.reason)

    @property
    def feasible(self) -> tuple[Row, ...]:
        """Of those built, the rows that keep to every constraint."""
        return tuple(r for r in self.built if self._is_feasible(r))

    @property
    def not_allowed(self) -> tuple[Row, ...]:
        """Of those built, the rows that break a constraint."""
        return tuple(r for r in self.built if not self._is_feasible(r))

    def _is_feasible(self, row: Row) -> bool:
        return all(e <= 0 for e in self.study.excesses(row.outcome.figures))

    def keeping(self, key: str) -> tuple[Row, ...]:
        """Of those built, the rows that keep to the constraint on a figure."""
        limit = self.study.file.constraint[key]
        return tuple(r for r in self.built if limit.excess(r.outcome.figures[key]) <= 0)

    @property
    def pareto(self) -> tuple[Row, ...]:
        """Feasible rows that no other feasible row beats; the first objective's best first."""
        if not self.study.file.objective:
            return ()
        costs = {r.slot: self.costs(r) for r in self.feasible}
        kept = [
            r for r in self.feasible if not any(_beats(c, costs[r.slot]) for c in costs.values())
        ]
        return tuple(sorted(kept, key=lambda r: costs[r.slot]))

    def best(self, count: int) -> tuple[Row, ...]:
        """So many designs to look at: of one objective the ranking; of several, spread evenly over the
        front, or all of it where it is shorter."""
        if len(self.study.file.objective) == 1:
            return tuple(sorted(self.feasible, key=self.costs))[:count]
        front = self.pareto
        if len(front) <= count:
            return front
        at = np.linspace(0, len(front) - 1, count).round().astype(int)
        return tuple(front[i] for i in at)

    def is_better(self, one: Row, other: Row) -> bool:
        """Whether a design is better in the first objective in which both differ."""
        return self.costs(one) < self.costs(other)

    def costs(self, row: Row) -> tuple[float, ...]:
        """Objectives, all to be made small."""
        sign = {"minimize": 1.0, "maximize": -1.0}
        objective = self.study.file.objective
        return tuple(sign[d] * row.outcome.figures[k] for k, d in objective.items())


def _beats(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    """Nowhere worse and somewhere better."""
    return one != other and all(a <= b for a, b in zip(one, other, strict=True))
