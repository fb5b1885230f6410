"""The three kinds of measurement, told apart by their columns."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from flexspline.geometry.ranges import SMALLEST_ANGLE_arcsec, STIFFNESS_Nm_per_rad, TORQUE_Nm
from flexspline.pipeline.diagnosis.table import Table, read_table

LARGEST_CYCLE = 1_000_000
FEWEST_SWEEP_ROWS = 4
"""One more than zero, stiffness and gap."""


@dataclass(frozen=True)
class History:
    """What a rig did, row by row: the input of every forward model.

    Attributes
    ----------
    torque_Nm : (n,) torque on the output.
    unit : (n,) index of the unit under test; `cycle` (n,) load cycle, counted from 0 in each unit.
    time_s, temperature_C, input_angle_deg : (n,), None where not recorded. `input_angle_deg` is where
        the wave generator was locked.
    """

    torque_Nm: np.ndarray
    unit: np.ndarray
    cycle: np.ndarray
    time_s: np.ndarray | None = None
    temperature_C: np.ndarray | None = None
    input_angle_deg: np.ndarray | None = None
    memo: dict[tuple[str, float], np.ndarray] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    """What operators have made of this history once and need again; never part of its value."""

    def __len__(self) -> int:
        return len(self.torque_Nm)

    def rows(self, chosen: np.ndarray) -> History:
        """The chosen rows (mask or indices)."""

        def part(values: np.ndarray | None) -> np.ndarray | None:
            return None if values is None else values[chosen]

        return History(
            self.torque_Nm[chosen], self.unit[chosen], self.cycle[chosen],
            part(self.time_s), part(self.temperature_C), part(self.input_angle_deg),
        )  # fmt: skip

    def shifted(self, offset_Nm: float) -> History:
        """The true torque, where the reading is `offset_Nm` too high."""
        return replace(self, torque_Nm=self.torque_Nm - offset_Nm)

    @property
    def sign(self) -> np.ndarray:
        """(n,) on which side of the gap the teeth bear: −1, 0 or 1."""
        return np.sign(self.torque_Nm)

    @property
    def unit_slices(self) -> list[np.ndarray]:
        """Row indices of each unit, in order."""
        return [np.flatnonzero(self.unit == u) for u in np.unique(self.unit)]


@dataclass(frozen=True)
class Sweep:
    """Torque sweeps with the wave generator locked: `angle_arcsec` (n,) for each row of `history`."""

    path: Path
    history: History
    angle_arcsec: np.ndarray
    units: tuple[str, ...]
    cycles: tuple[tuple[float, ...], ...]
    """The file's own cycle numbers of each unit."""
    line: np.ndarray
    cycles_recorded: bool
    ignored: tuple[str, ...] = ()
    sha256: str = ""

    def __len__(self) -> int:
        return len(self.angle_arcsec)


@dataclass(frozen=True)
class EndPoints:
    """Angles at +T and −T of several units; arrays (n,)."""

    path: Path
    unit: tuple[str, ...]
    torque_Nm: np.ndarray
    angle_plus_arcsec: np.ndarray
    angle_minus_arcsec: np.ndarray
    sha256: str = ""


@dataclass(frozen=True)
class Specimens:
    """Measured stiffness of several parts; `overrides` design keys with a value for each row."""

    path: Path
    specimen: tuple[str, ...]
    part: tuple[str, ...]
    stiffness_Nm_per_rad: np.ndarray
    stiffness_std_Nm_per_rad: np.ndarray | None
    overrides: dict[str, np.ndarray]
    line: np.ndarray
    part_recorded: bool = True
    sha256: str = ""


Measurement = Sweep | EndPoints | Specimens


def read_measurement(path: Path) -> Measurement:
    """Read a CSV file of any of the contract's three kinds.

    Raises
    ------
    MeasurementError : unreadable, no known kind, or values that cannot be.
    """
    table = read_table(path)
    if table.has("specimen", "stiffness_Nm_per_rad"):
        return _specimens(table)
    if table.has("angle_plus_arcsec", "angle_minus_arcsec"):
        return _end_points(table)
    if table.has("torque_Nm", "angle_arcsec"):
        return _sweep(table)
    wanted = {
        "a torque sweep": ("torque_Nm", "angle_arcsec"),
        "end points": ("unit", "torque_Nm", "angle_plus_arcsec", "angle_minus_arcsec"),
        "specimens": ("specimen", "stiffness_Nm_per_rad"),
    }
    kind, missing = min(
        ((k, [n for n in names if not table.has(n)]) for k, names in wanted.items()),
        key=lambda pair: len(pair[1]) / len(wanted[pair[0]]),
    )
    raise table.refuse(None, f"column {', '.join(missing)} is missing for {kind}")


def _sweep(table: Table) -> Sweep:
    n = len(table)
    if n < FEWEST_SWEEP_ROWS:
        raise table.refuse(
            n - 1, f"{n} data rows; a torque sweep needs at least {FEWEST_SWEEP_ROWS}"
        )
    if np.any(table.numbers["torque_Nm"]):  # none at all is too little data, and no error
        _refuse_empty(table, "torque_Nm", TORQUE_Nm.low)
    _refuse_empty(table, "angle_arcsec", SMALLEST_ANGLE_arcsec)
    found = history_of(table)
    return Sweep(
        table.path, found.history, table.numbers["angle_arcsec"], found.units, found.cycles,
        table.line, "cycle" in table.numbers, table.ignored, table.sha256,
    )  # fmt: skip


@dataclass(frozen=True)
class NamedHistory:
    """A file's history, the names of its units, and the file's own cycle numbers of each."""

    history: History
    units: tuple[str, ...]
    cycles: tuple[tuple[float, ...], ...]


def history_of(table: Table) -> NamedHistory:
    """What the rig did, by a table with `torque_Nm`.

    Raises
    ------
    MeasurementError : time or cycles that run backwards within a unit; cycles that are no numbers.
    """
    n = len(table)
    names = tuple(dict.fromkeys(table.labels.get("unit", ("",))))
    code = {name: i for i, name in enumerate(names)}
    unit = np.array([code[u] for u in table.labels.get("unit", ("",) * n)])
    _refuse_backward(table, "time_s", unit, "time runs backwards")
    _refuse_backward(table, "cycle", unit, "cycle numbers run backwards")
    torque = table.numbers["torque_Nm"]
    recorded = "cycle" in table.numbers
    cycle = table.numbers["cycle"] if recorded else np.zeros(n)
    if recorded:
        odd = np.flatnonzero((cycle != np.floor(cycle)) | (cycle < 0))
        if len(odd):
            raise table.refuse(
                int(odd[0]), f"cycle = {cycle[odd[0]]:g} is not a whole number from 0"
            )
        large = np.flatnonzero(cycle > LARGEST_CYCLE)
        if len(large):
            raise table.refuse(
                int(large[0]), f"cycle = {cycle[large[0]]:g} is beyond {LARGEST_CYCLE}"
            )
    counted = np.zeros(n, int)
    own: list[tuple[float, ...]] = []
    for u in range(len(names)):
        rows = np.flatnonzero(unit == u)
        given = cycle[rows] if recorded else counted_cycles(torque[rows])
        values, index = np.unique(given, return_inverse=True)
        counted[rows] = index if not recorded else (given - values[0]).astype(int)
        own.append(tuple(float(v) for v in values))
    history = History(
        torque, unit, counted,
        table.numbers.get("time_s"),
        table.numbers.get("temperature_C"),
        table.numbers.get("input_angle_deg"),
    )  # fmt: skip
    return NamedHistory(history, names, tuple(own))


def counted_cycles(torque_Nm: np.ndarray) -> np.ndarray:
    """Cycle number (n,) from 1, where the file has none.

    A cycle ends where the torque, having been beyond half its largest value on both sides, last rose
    through 0 before going beyond +½ again.
    """
    limit = np.abs(torque_Nm).max() / 2
    far = np.flatnonzero(np.abs(torque_Nm) > limit)
    positive = torque_Nm[far] > 0
    returns = far[1:][positive[1:] & ~positive[:-1]]  # first row beyond +½ after a row beyond −½
    first_positive = far[positive][:1]
    starts = []
    for row in returns:
        if len(first_positive) and row > first_positive[0]:
            below = np.flatnonzero(torque_Nm[:row] <= 0)
            starts.append(below[-1] + 1)
    return 1.0 + np.searchsorted(np.array(starts, int), np.arange(len(torque_Nm)), side="right")


def _refuse_backward(table: Table, name: str, unit: np.ndarray, reason: str) -> None:
    values = table.numbers.get(name)
    if values is None:
        return
    for u in np.unique(unit):
        rows = np.flatnonzero(unit == u)
        back = np.flatnonzero(np.diff(values[rows]) < 0)
        if len(back):
            row = rows[back[0] + 1]
            was = values[rows[back[0]]]
            raise table.refuse(int(row), f"{reason}: {name} = {values[row]:g} after {was:g}")


def _refuse_empty(table: Table, name: str, least: float) -> None:
    """Readings that are all nothing: a channel that was not connected, or a slipped exponent."""
    largest = np.abs(table.numbers[name]).max()
    if largest < least:
        unit = name.rpartition("_")[2].replace("Nm", "N·m")
        raise table.refuse(
            None,
            f"the largest {name} is {largest:g}: a measurement needs at least {least:g} {unit}; "
            "is the unit right, was the channel connected?",
        )


def _end_points(table: Table) -> EndPoints:
    for name in ("unit", "torque_Nm"):
        if not table.has(name):
            raise table.refuse(None, f"column {name} is missing for end points")
    torque = table.numbers["torque_Nm"]
    bad = np.flatnonzero(~((torque >= TORQUE_Nm.low) & (torque <= TORQUE_Nm.high)))
    if len(bad):
        reason = f"torque_Nm = {torque[bad[0]]:g}: must be {TORQUE_Nm} N·m; both signs are meant"
        raise table.refuse(int(bad[0]), reason)
    angles = np.abs([table.numbers[f"angle_{way}_arcsec"] for way in ("plus", "minus")])
    if angles.max() < SMALLEST_ANGLE_arcsec:
        _refuse_empty(table, "angle_plus_arcsec", SMALLEST_ANGLE_arcsec)
    return EndPoints(
        table.path, table.labels["unit"], torque,
        table.numbers["angle_plus_arcsec"], table.numbers["angle_minus_arcsec"], table.sha256,
    )  # fmt: skip


PARTS = ("flexspline", "shaft", "series")


def _specimens(table: Table) -> Specimens:
    n = len(table)
    part = table.labels.get("part", ("series",) * n)
    for i, p in enumerate(part):
        if p not in PARTS:
            raise table.refuse(i, f'part = "{p[:40]}": must be one of {", ".join(PARTS)}')
    for name in ("stiffness_Nm_per_rad", "stiffness_std_Nm_per_rad"):
        values = table.numbers.get(name, np.ones(n))
        low, high = STIFFNESS_Nm_per_rad
        bad = np.flatnonzero(~((values >= low) & (values <= high)))
        if len(bad):
            reason = f"{name} = {values[bad[0]]:g}: must be {STIFFNESS_Nm_per_rad} N·m/rad"
            raise table.refuse(int(bad[0]), reason)
    return Specimens(
        table.path, table.labels["specimen"], part,
        table.numbers["stiffness_Nm_per_rad"], table.numbers.get("stiffness_std_Nm_per_rad"),
        {k: v for k, v in table.numbers.items() if "." in k}, table.line,
        "part" in table.labels, table.sha256,
    )  # fmt: skip
