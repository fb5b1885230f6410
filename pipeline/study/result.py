"""What a study found: its rows, which keep to the constraints, which are best."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pipeline.study.load import Study
from pipeline.study.scatter import Scatter
from pipeline.study.store import Row
from pipeline.study.verified import Verified


@dataclass(frozen=True)
class StudyResult:
    """All rows by slot, and the order of the best."""

    study: Study
    rows: tuple[Row, ...]
    scatter: tuple[Scatter, ...] = ()
    """Of a tolerance study, by figure."""
    verified: tuple[Verified, ...] = ()
    """Of the best designs, by rank."""

    @property
    def built(self) -> tuple[Row, ...]:
        """Rows with figures."""
        return tuple(r for r in self.rows if not r.outcome.reason)

    @property
    def feasible(self) -> tuple[Row, ...]:
        """Rows with figures that keep to every constraint."""
        limits = self.study.file.constraint
        return tuple(
            r for r in self.built
            if all(limit.excess(r.outcome.figures[k]) <= 0 for k, limit in limits.items())
        )  # fmt: skip

    @property
    def pareto(self) -> tuple[Row, ...]:
        """Feasible rows that no other feasible row beats; the first objective's best first."""
        candidates = self.feasible
        kept = [
            r for r in candidates
            if not any(_beats(self._costs(o), self._costs(r)) for o in candidates)
        ]  # fmt: skip
        return tuple(sorted(kept, key=self._costs))

    def _costs(self, row: Row) -> tuple[float, ...]:
        """Objectives, all to be made small."""
        return costs(self.study.file.objective, row)


def costs(objective: Mapping[str, str], row: Row) -> tuple[float, ...]:
    """Objectives of a row, all to be made small."""
    sign = {"minimize": 1.0, "maximize": -1.0}
    return tuple(sign[d] * row.outcome.figures[k] for k, d in objective.items())


def _beats(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    """Nowhere worse and somewhere better."""
    return one != other and all(a <= b for a, b in zip(one, other, strict=True))
