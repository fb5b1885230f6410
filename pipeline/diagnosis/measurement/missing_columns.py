"""The error for a file that lacks columns which a kind of measurement needs."""

from __future__ import annotations

from collections.abc import Sequence

from flexspline.pipeline.diagnosis.measurement.columns import unit_not_known
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.table import MeasuredTable

MEANT = {
    "unit": "name or number of the gear measured",
    "specimen": "name or number of the part measured",
}
"""What a column of labels holds: "unit" alone reads like a unit of measurement."""
HEADS_SHOWN = 12
"""Most columns that a message lists."""


def columns_missing(table: MeasuredTable, missing: Sequence[str], kind: str) -> MeasurementError:
    """Says what the columns hold, and what the file has."""
    for name in missing:
        for head in table.read_as.ignored:
            if (why := unit_not_known(head, name)) is not None:
                return MeasurementError(table.path, table.read_as.head_line, why)
    named = (f"{name} ({MEANT[name]})" if name in MEANT else name for name in missing)
    reason = f"column {', '.join(named)} is missing for {kind}"
    heads = [h for h in table.read_as.heads if h][:HEADS_SHOWN]
    has = f"the header in line {table.read_as.head_line} has: {', '.join(heads)}"
    parted = "; separate the columns by commas, semicolons or tabs" if len(heads) == 1 else ""
    return table.refuse(None, f"{reason}; {has}{parted}")
