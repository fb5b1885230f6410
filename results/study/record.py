"""A study's result for machines and in a few lines for people."""

from __future__ import annotations

from typing import Any

from pipeline.study.result import StudyResult
from pipeline.study.scatter import Scatter
from pipeline.study.store import Row
from pipeline.study.verified import Verified
from results.records import program_version
from results.study.labels import entry
from results.study.why import disagreement, misses, signed

SHOWN = 5


def summary(result: StudyResult) -> dict[str, Any]:
    """How many designs, how many failed, the best."""
    file = result.study.file
    best = result.pareto if len(result.pareto) >= SHOWN else result.best(SHOWN)
    return {
        "study": result.study.name,
        "design": result.study.design.name,
        "version": program_version(),
        "method": file.run.method,
        "evaluations": len(result.rows),
        "failed": len(result.rows) - len(result.built),
        "feasible": len(result.feasible),
        "best": [_row(r) for r in best],
        **({"verified": [_verified(v) for v in result.verified]} if result.verified else {}),
        **({"tolerance": [_scatter(s) for s in result.scatter]} if result.scatter else {}),
    }


def _verified(v: Verified) -> dict[str, Any]:
    if v.reason:
        return {"design": v.slot, "reason": v.reason}
    figures: dict[str, dict[str, Any]] = {}
    for c in v.checks:
        figures[c.key] = {"fast": c.fast, "solid": c.solid, "agrees": c.agrees}
        if c.fast_bounds and c.solid_bounds:
            figures[c.key] |= {
                "fast_bounds": list(c.fast_bounds),
                "solid_bounds": list(c.solid_bounds),
            }
    return {"design": v.slot, "figures": figures}


def _scatter(s: Scatter) -> dict[str, Any]:
    i = s.indices
    by_input = zip(s.inputs, i.first, i.first_conf, i.total, i.total_conf, strict=True)
    return {
        "figure": s.key,
        "mean": s.mean,
        "std": s.std,
        "range_95": [s.low, s.high],
        "dropped_blocks": s.dropped,
        "surface_rms": s.surface_rms,
        "inputs": [
            {
                "key": x.key,
                "nominal": x.nominal,
                "std": x.std,
                "distribution": "normal" if x.normal else "uniform",
                "sobol_first": float(first),
                "sobol_first_conf": float(first_conf),
                "sobol_total": float(total),
                "sobol_total_conf": float(total_conf),
                "tightened": [
                    {"factor": t.factor, "range_95_width": t.width, "bought": t.bought}
                    for t in s.tightened
                    if t.key == x.key
                ],
            }
            for x, first, first_conf, total, total_conf in by_input
        ],
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
    for row in () if result.scatter else result.best(SHOWN):
        values = ", ".join(
            f"{entry(k).name} {entry(k).with_unit(v)}" for k, v in row.values.items()
        )
        figures = ", ".join(
            f"{entry(k).symbol} = {entry(k).with_unit(row.outcome.figures[k])}"
            for k in file.objective
        )
        lines.append(f"  design {row.slot}: {values}: {figures}")
    lines += [f"  {line}" for line in misses(result)]
    for v in result.verified:
        lines += _verified_words(v)
    for s in result.scatter:
        lines += _scatter_words(s)
    return "\n".join([*lines, *(f"  {name}" for name in record["files"])])


def _verified_words(v: Verified) -> list[str]:
    if v.reason:
        return [f"  design {v.slot}, solid model: {v.reason}"]
    lines = [f"  design {v.slot}, fast and solid model:"]
    for c in v.checks:
        figure = entry(c.key)
        alarm = "" if c.agrees else f"  ALARM: {disagreement(c)}"
        lines.append(
            f"    {figure.symbol} {figure.text(c.fast)} and {figure.with_unit(c.solid)} "
            f"({signed(c.difference_pct, 1)} %){alarm}"
        )
    return lines


def _scatter_words(s: Scatter) -> list[str]:
    figure = entry(s.key)
    lines = [
        f"  {figure.name}: mean {figure.with_unit(s.mean)}, standard deviation "
        f"{figure.with_unit(s.std)}, 95 % from {figure.range_text(s.low, s.high)} {figure.unit}"
    ]
    order = sorted(range(len(s.inputs)), key=lambda i: -s.indices.total[i])
    for i in order:
        x = s.inputs[i]
        half = next(t for t in s.tightened if t.key == x.key and t.factor == 0.5)
        lines.append(
            f"    {entry(x.key).name}: Sobol index {s.indices.first[i]:z.2f} ± "
            f"{s.indices.first_conf[i]:.2f}, total {s.indices.total[i]:z.2f} ± "
            f"{s.indices.total_conf[i]:.2f}; half its scatter buys {max(0.0, half.bought):.2f} {figure.unit}"
        )
    return lines
