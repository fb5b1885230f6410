"""study.csv, and study.parquet where pyarrow is: one row per design."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

from flexspline.pipeline.study.result import StudyResult
from flexspline.results.atomic import write_bytes
from flexspline.results.study.labels import published

StudyColumns = dict[str, list[Any]]


def table_of(result: StudyResult) -> StudyColumns:
    """Columns by name: slot, varied keys, figures, whether the constraints hold, reason, seconds.

    A figure that a design does not have is None.
    """
    rows = result.rows
    keys = list(dict.fromkeys(k for r in rows for k in r.values))
    figures_of_rows = [published(r.outcome.figures) for r in rows]
    figures = list(dict.fromkeys(k for row in figures_of_rows for k in row))
    feasible = {r.slot for r in result.feasible}
    table: StudyColumns = {"design": [r.slot for r in rows]}
    table |= {k: [r.values[k] for r in rows] for k in keys}
    table |= {k: [row.get(k) for row in figures_of_rows] for k in figures}
    table["feasible"] = [r.slot in feasible for r in rows]
    table["reason"] = [r.outcome.reason for r in rows]
    table["wall_s"] = [round(r.outcome.seconds, 4) for r in rows]
    return table


def write_csv(path: Path, table: StudyColumns) -> None:
    """Comma-separated, one header line, all digits of every number."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(table)
    for row in zip(*table.values(), strict=True):
        writer.writerow(
            ["" if v is None else str(v).lower() if isinstance(v, bool) else v for v in row]
        )
    write_bytes(path, out.getvalue().encode())


def write_parquet(path: Path, table: StudyColumns) -> bool:
    """The same columns, typed; False, and nothing written, where pyarrow is not installed."""
    try:
        import pyarrow as pa
        from pyarrow import parquet
    except ImportError:
        return False
    sink = pa.BufferOutputStream()
    parquet.write_table(pa.table(table), sink)
    write_bytes(path, sink.getvalue().to_pybytes())
    return True
