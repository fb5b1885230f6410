"""A study's result for machines and in a few lines for people."""

from __future__ import annotations

from typing import Any

from pipeline.study.result import StudyResult
from pipeline.study.store import Row
from results.records import program_version
from results.study.labels import entry

SHOWN = 5


def summary(result: StudyResult) -> dict[str, Any]:
    """How many designs, how many failed, the best."""
    file = result.study.file
    best = result.pareto if file.objective else ()
    return {
        "study": result.study.name,
        "design": result.study.design.name,
        "version": program_version(),
        "method": file.run.method,
        "evaluations": len(result.rows),
        "failed": len(result.rows) - len(result.built),
        "feasible": len(result.feasible),
        "best": [_row(r) for r in best],
    }


def _row(row: Row) -> dict[str, Any]:
    return {
        "design": row.slot,
        "values": dict(row.values),
        "figures": dict(row.outcome.figures),
    }


def words(result: StudyResult, record: dict[str, Any]) -> str:
    """For the terminal."""
    file = result.study.file
    lines = [
        f"{record['study']}: {len(result.built)} of {len(result.rows)} designs built and solved, "
        f"{len(result.feasible)} keep to the constraints"
    ]
    for row in (result.pareto if file.objective else ())[:SHOWN]:
        values = ", ".join(
            f"{entry(k).name} {entry(k).with_unit(v)}" for k, v in row.values.items()
        )
        figures = ", ".join(
            f"{entry(k).symbol} = {entry(k).with_unit(row.outcome.figures[k])}"
            for k in file.objective
        )
        lines.append(f"  design {row.slot}: {values}: {figures}")
    return "\n".join([*lines, *(f"  {name}" for name in record["files"])])
