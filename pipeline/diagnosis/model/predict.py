"""Angles of a torque history by an extended model."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.sensor_drift import DRIFT
from flexspline.pipeline.diagnosis.causes.wear import WEAR
from flexspline.pipeline.diagnosis.measurement.history import History
from flexspline.pipeline.diagnosis.measurement.history_reading import NamedHistory, history_of
from flexspline.pipeline.diagnosis.measurement.read_as import AS_OURS, ReadAs
from flexspline.pipeline.diagnosis.measurement.table import MeasuredTable, read_table
from flexspline.pipeline.diagnosis.model.doubt import deviation_of
from flexspline.pipeline.diagnosis.model.extended_model import BEYOND_GEARS, first_beyond
from flexspline.pipeline.diagnosis.model.extrapolation import RowsBeyond, extrapolated
from flexspline.pipeline.diagnosis.model.model_file import ModelFile
from flexspline.pipeline.diagnosis.model.shape_check import channels_needed

CYCLES_COUNT, CLOCK_COUNTS = WEAR, DRIFT
"""Causes that go on from the record's first cycle and from its first row's time."""


@dataclass(frozen=True)
class Predicted:
    """What a model says of a history.

    Attributes
    ----------
    angle_arcsec : (n,). angle_std_arcsec : (n,) one standard deviation of a reading from it; None where the
        model does not say.
    new_units : that the model's record does not have, so that their zero is taken as 0; "" for a file without
        units.
    beyond : rows outside of what the record spans, by channel.
    """

    angle_arcsec: np.ndarray
    angle_std_arcsec: np.ndarray | None
    new_units: tuple[str, ...]
    beyond: tuple[RowsBeyond, ...]
    read_as: ReadAs = AS_OURS


def predict_file(file: ModelFile, csv: Path, counts_per_turn: float | None = None) -> Predicted:
    """The angle for each row of a file with `torque_Nm` and whatever channels the model needs.

    Cycles are counted from the record's first one, by the file's own numbers. Drift goes on from the
    record's first row where the file's clock stands later; an earlier one is another clock, and drift
    then starts with the file. `counts_per_turn` of the encoder, where a column is in counts.

    Raises
    ------
    MeasurementError : the file cannot be read, lacks a channel that a cause of the model needs, or
        has a torque that no gear carries.
    """
    table = read_table(csv, counts_per_turn)
    if not table.has("torque_Nm"):
        raise table.refuse(None, "column torque_Nm is missing")
    torque = table.numbers["torque_Nm"]
    if (row := first_beyond(torque)) is not None:
        raise table.refuse(row, f"torque_Nm = {torque[row]:g} {BEYOND_GEARS}")
    reading = history_of(table)
    history = _as_recorded(reading, file, table)
    if not file.provenance.time_recorded:  # there rows stood for seconds
        history = replace(history, time_s=np.arange(len(history), dtype=float))
    for cause_id, elements in file.model.elements.items():
        for channel in channels_needed(known_causes()[cause_id], elements):
            if getattr(history, channel) is None:
                raise table.refuse(
                    None, f"column {channel} is missing; {cause_id} in {file.path.name} needs it"
                )
    angle = file.model.angle_of(history, reading.units) + _drifted_before(reading, file, history)
    new = tuple(u for u in reading.units if u not in file.model.zeros_arcsec)
    if file.doubt is None:
        return Predicted(angle, None, new, (), table.read_as)
    deviation = deviation_of(file.model, file.doubt, history, reading.units)
    beyond = extrapolated(deviation, file.doubt.span, history, timed=file.provenance.time_recorded)
    return Predicted(angle, deviation.std_arcsec, new, tuple(beyond), table.read_as)


def _drifted_before(named: NamedHistory, file: ModelFile, history: History) -> np.ndarray:
    """(n,) how much more the reading has drifted than from the file's own first row."""
    more = np.zeros(len(history))
    elements = file.model.elements.get(CLOCK_COUNTS)
    if elements is None or history.time_s is None:
        return more
    drift = known_causes()[CLOCK_COUNTS]
    for code, name in enumerate(named.units):
        rows = np.flatnonzero(history.unit == code)
        first = file.provenance.first_time_s.get(name, np.inf)
        if history.time_s[rows[0]] > first:
            own = history.rows(rows)
            with_first = history.rows(np.r_[rows[0], rows])
            time = np.r_[first, history.time_s[rows]]
            since = drift.angle_arcsec(elements, replace(with_first, time_s=time))[1:]
            more[rows] = since - drift.angle_arcsec(elements, own)
    return more


def _as_recorded(named: NamedHistory, file: ModelFile, table: MeasuredTable) -> History:
    """The history with its cycles counted as in the model's record."""
    if "cycle" not in table.numbers:
        return named.history
    cycle = named.history.cycle.copy()
    for code, name in enumerate(named.units):
        rows = named.history.unit == code
        first = file.provenance.first_cycle.get(name, named.cycles[code][0])
        before = int(first - named.cycles[code][0])
        if before > 0 and CYCLES_COUNT in file.model.elements:
            raise table.refuse(
                int(np.flatnonzero(rows)[0]),
                f"cycle = {named.cycles[code][0]:g} lies before the model's first, {first:g}",
            )
        cycle[rows] += max(-before, 0)
    return replace(named.history, cycle=cycle)
