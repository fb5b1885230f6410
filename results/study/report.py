"""report.pdf of a study: finished text, set by a fixed template; text from files enters as data."""

from __future__ import annotations

import json
import shutil
import tempfile
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

from pipeline.study.evaluate import LOBE_TOLERANCE, TORSION_TOLERANCE
from pipeline.study.mass import DENSITY_KG_M3
from pipeline.study.result import StudyResult
from pipeline.study.scatter import Scatter
from results.atomic import write_bytes
from results.records import program_version
from results.report.write import ReportError
from results.study.labels import entry
from results.study.why import failures, influences, limits

TEMPLATE = "study.typ"
COLUMNS = 5
"""Best designs side by side."""
METHODS = {
    "grid": "Every combination of the given values.",
    "sobol": "Designs spread evenly by a scrambled Sobol sequence.",
    "optimize": "Designs chosen by an optimiser that learns from those before.",
    "tolerance": "Scatter of uncertainty and tolerances through the whole chain (Saltelli's scheme).",
}
WIDTHS = {"pareto.png": 75, "best.png": 48, "convergence.png": 75, "parallel.png": 88}
"""Percent of the page's width."""
CAPTIONS = {
    "pareto.png": "Every design built, and the front that none beats.",
    "parallel.png": "Every design as a line over the varied dimensions and the objectives.",
    "convergence.png": "Every design in the order chosen, and the best so far.",
    "best.png": "The best designs in section.",
    "tolerance.png": "Distribution, Sobol indices, and what tighter tolerances buy.",
}


def write_study_report(path: Path, result: StudyResult, pictures: Sequence[Path]) -> None:
    """Write the PDF, whole or not at all.

    Raises
    ------
    ReportError : typst refused the document.
    """
    import typst

    with tempfile.TemporaryDirectory() as scratch:
        root = Path(scratch)
        source = root / TEMPLATE
        source.write_bytes(files("results.study").joinpath(TEMPLATE).read_bytes())
        for picture in pictures:
            shutil.copyfile(picture, root / picture.name)
        data = json.dumps(payload(result, [p.name for p in pictures]))
        try:
            pdf = typst.compile(
                str(source), root=str(root), sys_inputs={"report": data}, timestamp=0
            )
        except typst.TypstError as error:
            raise ReportError(f"typst could not set the report: {error}") from error
    write_bytes(path, pdf)


def payload(result: StudyResult, pictures: Sequence[str]) -> dict[str, Any]:
    """The content as JSON values, in the order in which the template sets it."""
    file = result.study.file
    return {
        "name": result.study.name,
        "design": result.study.design.name,
        "version": program_version(),
        "method": METHODS[file.run.method],
        "counts": _counts(result),
        "best": _best(result),
        "why": [*influences(result), *limits(result)],
        "verified": _verified(result),
        "failures": failures(result),
        "scatter": [_scatter(s) for s in result.scatter],
        "pictures": [
            [n, CAPTIONS.get(n, CAPTIONS["tolerance.png"]), WIDTHS.get(n, 100)] for n in pictures
        ],
        "notes": _notes(result),
    }


def _counts(result: StudyResult) -> str:
    said = f"{len(result.built)} of {len(result.rows)} designs were built and solved"
    if result.study.file.constraint:
        said += f"; {len(result.feasible)} of them keep to every constraint"
    return said + "."


def _best(result: StudyResult) -> list[list[str]]:
    """A header, then a line per varied key and figure: name, then the best designs' values."""
    file = result.study.file
    chosen = () if result.scatter else result.best(COLUMNS)
    if not chosen:
        return []
    lines = [["", *(f"design {r.slot}" for r in chosen)]]
    for key in file.vary:
        q = entry(key)
        lines.append([q.axis, *(q.text(r.values[key]) for r in chosen)])
    for key in dict.fromkeys([*file.objective, *file.constraint, "flexspline_mass_g"]):
        q = entry(key)
        if all(key in r.outcome.figures for r in chosen):
            lines.append([q.axis, *(q.text(r.outcome.figures[key]) for r in chosen)])
    return lines


def _verified(result: StudyResult) -> list[list[str]]:
    lines = []
    for v in result.verified:
        if v.reason:
            lines.append([f"design {v.slot}", v.reason, "", "", "failed"])
        for c in v.checks:
            q = entry(c.key)
            lines.append([
                f"design {v.slot}", q.axis,
                q.range_text(*c.fast_bounds) if c.fast_bounds else q.text(c.fast),
                q.range_text(*c.solid_bounds) if c.solid_bounds else q.text(c.solid),
                "agree" if c.agrees else "ALARM",
            ])  # fmt: skip
    return lines


def _scatter(s: Scatter) -> dict[str, Any]:
    q, lines = entry(s.key), []
    for i in sorted(range(len(s.inputs)), key=lambda i: -s.indices.total[i]):
        x = s.inputs[i]
        bought = {t.factor: t.bought for t in s.tightened if t.key == x.key}
        unit = entry(x.key)
        spread = x.std if x.normal else x.high - x.nominal
        kind = "s =" if x.normal else "±"
        lines.append([
            unit.name, f"{unit.text(x.nominal)}, {kind} {unit.with_unit(spread)}",
            f"{s.indices.first[i]:.2f} ± {s.indices.first_conf[i]:.2f}",
            f"{s.indices.total[i]:.2f} ± {s.indices.total_conf[i]:.2f}",
            *(f"{max(0.0, bought[f]):.1f}" for f in (0.75, 0.5, 0.25, 0.0)),
        ])  # fmt: skip
    sentence = (
        f"{q.name}: mean {q.with_unit(s.mean)}, standard deviation {q.with_unit(s.std)}, 95 % from "
        f"{q.range_text(s.low, s.high)} {q.unit}. The quadratic surface behind the last four columns "
        f"misses {s.surface_rms:.2g} {q.unit} (root mean square)."
    )
    if s.dropped:
        sentence += f" {s.dropped} sample blocks with a design that cannot be built are left out."
    return {"sentence": sentence, "lines": lines, "unit": q.unit}


def _notes(result: StudyResult) -> list[str]:
    notes = [
        f"Fast model: the axisymmetric one of the same meridian; bolt holes and keyway are left out. "
        f"K between guaranteed bounds at most {100 * TORSION_TOLERANCE:g} % apart, lobes "
        f"{100 * LOBE_TOLERANCE:g} %.",
        f"Mass at {DENSITY_KG_M3:g} kg/m³ (steel), since the design file has no density.",
    ]
    if not result.verified:
        notes.append("No design was solved again with the solid model (run.verify = 0).")
    return notes
