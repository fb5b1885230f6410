"""A study's result as JSON, and in a few lines for the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from flexspline import __version__
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.scatter import Scatter
from flexspline.pipeline.study.verified import Verified
from flexspline.results.numbers import signed
from flexspline.results.quantities import BY_KEY
from flexspline.results.study.failures import FailureReason, causes, failure_lines
from flexspline.results.study.gains import gain_text, gains_shown, least_gain
from flexspline.results.study.labels import LISTED_DESIGNS, entry, published, valued
from flexspline.results.study.scatter_section import index_text, source_words
from flexspline.results.study.unbeaten import start_breaks, unbeaten_start
from flexspline.results.study.why import disagreement, incomplete, misses
from flexspline.results.terminal import width


def summary(result: StudyResult) -> dict[str, Any]:
    """How many designs, how many failed or lack a figure that nothing asks for, by cause, the best."""
    file = result.study.file
    best = result.pareto if len(result.pareto) >= LISTED_DESIGNS else result.best(LISTED_DESIGNS)
    return {
        "study": result.study.name,
        "design": result.study.design.name,
        "version": __version__,
        "method": file.run.method,
        "evaluations": len(result.rows),
        "failed": len(result.rows) - len(result.built),
        "incomplete": len(result.incomplete),
        **({"causes": [_cause(c) for c in reasons]} if (reasons := causes(result)) else {}),
        "feasible": len(result.feasible),
        **({"start": _start(result, result.start)} if result.start else {}),
        "best": [_row(r) for r in best],
        **({"verified": [_verified(v) for v in result.verified]} if result.verified else {}),
        **({"tolerance": [_scatter(s) for s in result.scatter]} if result.scatter else {}),
        **({"no_tolerance": result.unscattered} if result.unscattered else {}),
    }


def _cause(cause: FailureReason) -> dict[str, Any]:
    example = {"design": cause.example.slot, "fault": cause.fault}
    return {"cause": cause.name, "designs": cause.designs, "example": example}


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
    """Indices, tightening and the surface's Q² are absent where they are not known."""
    record: dict[str, Any] = {
        "figure": s.key,
        "mean": s.mean,
        "std": s.std,
        "range_95": [s.low, s.high],
        "dropped_designs": s.dropped,
        "inputs": [_input(s, i) for i in range(len(s.inputs))],
    }
    if s.indices:
        record["indices_from"] = "surface" if s.surface else "sample"
    if s.surface:
        record["surface_rms"] = s.surface.misfit**0.5
    if s.shares and s.shares.explained is not None:
        record["surface_explained"] = s.shares.explained
    if s.shares and s.shares.enough is not None:
        record["evaluations_that_would_do"] = s.shares.enough
    return record


def _input(s: Scatter, i: int) -> dict[str, Any]:
    x, known = s.inputs[i], s.indices
    record: dict[str, Any] = {
        "key": x.key,
        "nominal": x.nominal,
        "std": x.std,
        "distribution": "normal" if x.normal else "uniform",
    }
    if known:
        for name, value, ends in (
            ("sobol_first", known.first[i], known.first_ends[i]),
            ("sobol_total", known.total[i], known.total_ends[i]),
        ):
            record[name] = float(value)
            record[f"{name}_conf"] = float(max(value - ends[0], ends[1] - value))
            record[f"{name}_95"] = [float(e) for e in ends]
    if s.tightened:
        record["tightened"] = [
            {"factor": t.factor, "range_95_width": t.width, "bought": t.bought}
            for t in s.tightened
            if t.key == x.key
        ]
    return record


def _start(result: StudyResult, start: Outcome) -> dict[str, Any]:
    record = {"values": result.study.start_values, "figures": published(start.figures)}
    return record | ({"reason": start.reason} if start.reason else {})


def _row(row: Row) -> dict[str, Any]:
    return {
        "design": row.slot,
        "values": dict(row.values),
        "figures": published(row.outcome.figures),
    }


def words(result: StudyResult, record: dict[str, Any]) -> str:
    """For the terminal."""
    file = result.study.file
    lines = [
        f"{record['study']}: {len(result.built)} of {len(result.rows)} designs built and solved"
        + (f", {len(result.feasible)} meet every constraint" if file.constraint else "")
    ]
    if result.incomplete:
        lines.append(f"  {incomplete(result)}")
    best = () if result.about_scatter else result.best(LISTED_DESIGNS)
    lines += _best_lines(result, best)
    lines += [f"  {line}" for line in (*unbeaten_start(result), *misses(result))]
    lines += [f"  {line}" for line in failure_lines(result)]
    if result.unscattered:
        lines.append(f"  {result.unscattered}")
    for v in result.verified:
        lines += _verified_words(v)
    for s in result.scatter:
        lines += _scatter_words(s)
    return "\n".join([*lines, *(f"  {name}" for name in record["files"])])


def _best_lines(result: StudyResult, best: Sequence[Row]) -> list[str]:
    """The start and each design, constrained figures at the end, or below where one line is too long."""
    if not best:
        return []
    designs = [(f"design {row.slot}", row.values, row.outcome) for row in best]
    if result.start is not None:
        designs.insert(0, ("start", result.study.start_values, result.start))
    constrained = [k for k in result.study.file.constraint if k not in result.study.file.objective]
    begun = [_line(result, *design) for design in designs]
    more = [_figures(constrained, outcome.figures) for _, _, outcome in designs]
    beside = [", ".join(filter(None, both)) for both in zip(begun, more, strict=True)]
    fits = all(len(line) <= width() for line in beside)
    lines = beside if fits else begun
    if breaks := start_breaks(result):
        lines[0] += f"; {breaks}"
    if fits:
        return lines
    return ["\n    ".join(filter(None, both)) for both in zip(lines, more, strict=True)]


def _figures(keys: Iterable[str], figures: Mapping[str, float]) -> str:
    """Those that a design has, by their symbols; a bound, which has its figure's, by its name."""
    named = ((entry(k), k) for k in keys if k in figures)
    return ", ".join(
        f"{q.symbol if k in BY_KEY else q.name} = {valued(k, figures)}" for q, k in named
    )


def _line(result: StudyResult, name: str, values: Mapping[str, float], outcome: Outcome) -> str:
    """A design's varied values and its objectives; why these are missing, where they are."""
    dimensions = ", ".join(f"{entry(k).name} {entry(k).with_unit(v)}" for k, v in values.items())
    figures = _figures(result.study.file.objective, outcome.figures)
    return f"  {name}: {dimensions}: {figures or outcome.reason}"


def _verified_words(v: Verified) -> list[str]:
    if v.reason:
        return [f"  design {v.slot}, solid model: {v.reason}"]
    lines = [f"  design {v.slot}, fast and solid model:"]
    for c in v.checks:
        figure = entry(c.key)
        alarm = "" if c.agrees else f"  ALARM: {disagreement(c)}"
        bounds = (
            f"; solid model from {figure.range_text(*c.solid_bounds)}" if c.solid_bounds else ""
        )
        lines.append(
            f"    {figure.symbol} {figure.text(c.fast)} and {figure.with_unit(c.solid)} "
            f"({signed(c.difference_pct, 1)} %{bounds}){alarm}"
        )
    return lines


def _scatter_words(s: Scatter) -> list[str]:
    figure = entry(s.key)
    lines = [
        f"  {figure.name}: mean {figure.with_unit(s.mean)}, standard deviation "
        f"{figure.with_unit(s.std)}, 95 % from {figure.range_text(s.low, s.high)} {figure.unit}"
    ]
    lines.append(f"    {source_words(s)}")
    for i in s.order if s.indices else ():
        lines.append(f"    {entry(s.inputs[i].key).name}: {', '.join(_shares(s, i))}")
    return lines


def _shares(s: Scatter, i: int) -> list[str]:
    """An input's indices, and by how much half its scatter narrows the 95 % range."""
    if s.indices is None:
        return []
    first = index_text(s.indices.first[i], s.indices.first_ends[i])
    texts = [
        f"Sobol index {first}",
        f"total {index_text(s.indices.total[i], s.indices.total_ends[i])}",
    ]
    half = gains_shown(s).get((s.inputs[i].key, 0.5))
    if half is not None:
        less = f"{gain_text(half, least_gain(s))} {entry(s.key).unit}"
        texts.append(f"with half its scatter the 95 % range is {less} narrower")
    return texts
