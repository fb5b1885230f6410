"""A CSV file as named columns of checked numbers in our units."""

from __future__ import annotations

import csv
import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

import numpy as np

from flexspline.geometry.input_file import InputFileError, read_input
from flexspline.geometry.ranges import SMALLEST_NUMBER
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.units import KELVIN_AT_0_C, QUANTITIES

LARGEST_BYTES = 200_000_000
"""Two million rows of 100 letters; a file beyond this is some other file, or never ends."""
LARGEST_ROWS = 2_000_000
"""Ten readings a second fill them in two days and a half; a fit takes minutes and GB on them."""
LARGEST_NUMBER = 1e12
"""Beyond this no rig reads; a slipped column or exponent does."""

LABELS = ("unit", "specimen", "part")
PLAIN = ("cycle",)


@dataclass(frozen=True)
class MeasuredTable:
    """Columns by our name, e.g. `torque_Nm`; numbers (n,) and labels; `line` (n,) in the file."""

    path: Path
    numbers: Mapping[str, np.ndarray]
    labels: Mapping[str, tuple[str, ...]]
    line: np.ndarray
    ignored: tuple[str, ...]
    sha256: str
    """Of the file's bytes."""

    def __len__(self) -> int:
        return len(self.line)

    def has(self, *names: str) -> bool:
        """Whether all these columns exist."""
        return all(n in self.numbers or n in self.labels for n in names)

    def refuse(self, row: int | None, reason: str) -> MeasurementError:
        """The error for data row `row`, None for the whole file."""
        return MeasurementError(self.path, None if row is None else int(self.line[row]), reason)


def read_table(path: Path) -> MeasuredTable:
    """Read a measurement.

    Lines beginning with # are comments. Columns whose name is no quantity of docs/contract.md are kept
    aside as `ignored`, except dotted design keys, which are read as numbers.

    Raises
    ------
    MeasurementError : anything that cannot be read without guessing.
    """
    raw = _bytes(path)
    lines, numbers_of = _lines(path, raw)
    if not lines:
        raise MeasurementError(
            path, None, "holds no header line; expected columns such as torque_Nm"
        )
    reader = csv.reader(lines, strict=True)
    try:
        rows = list(reader)
    except csv.Error as error:
        raise MeasurementError(
            path, numbers_of[min(reader.line_num, len(lines)) - 1], str(error)
        ) from None
    header = [h.strip() for h in rows[0]]
    columns = _columns(path, numbers_of[0], header)
    body = rows[1:]
    for i, row in enumerate(body):
        if len(row) != len(header):
            raise MeasurementError(
                path, numbers_of[i + 1], f"{len(row)} fields where the header has {len(header)}"
            )
    if not body:
        raise MeasurementError(path, numbers_of[0], "a header and no data rows")
    numbers: dict[str, np.ndarray] = {}
    labels: dict[str, tuple[str, ...]] = {}
    line = np.array(numbers_of[1:])
    for j, column in enumerate(columns):
        if column is None:
            continue
        texts = [row[j].strip() for row in body]
        if column.name in LABELS:
            empty = next((i for i, t in enumerate(texts) if not t), None)
            if empty is not None:
                raise MeasurementError(path, int(line[empty]), f"{header[j]} is empty")
            labels[column.name] = tuple(texts)
        else:
            values = _numbers(path, header[j], texts, line)
            large = np.flatnonzero(np.abs(values) > LARGEST_NUMBER)
            if len(large):
                found = f"{header[j]} = {values[large[0]]:g} is beyond ±{LARGEST_NUMBER:g}"
                raise MeasurementError(path, int(line[large[0]]), found)
            largest = np.abs(values).max()
            if 0 < largest < SMALLEST_NUMBER:
                reason = f"the largest {header[j]} is {largest:g}: no rig reads that; is an exponent wrong?"
                raise MeasurementError(path, None, reason)
            values = values * column.factor + column.shift
            numbers[column.name] = np.where(np.abs(values) < SMALLEST_NUMBER, 0.0, values)
    ignored = tuple(h for h, c in zip(header, columns, strict=True) if c is None)
    return MeasuredTable(path, numbers, labels, line, ignored, hashlib.sha256(raw).hexdigest())


@dataclass(frozen=True)
class _ReadColumn:
    name: str
    factor: float = 1.0
    shift: float = 0.0


def _bytes(path: Path) -> bytes:
    try:
        return read_input(path, LARGEST_BYTES, "a measured file")
    except InputFileError as error:
        raise MeasurementError(path, None, str(error)) from None


def _lines(path: Path, raw: bytes) -> tuple[list[str], list[int]]:
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw[: error.start].count(b"\n") + 1
        raise MeasurementError(
            path, line, f"byte {raw[error.start]:#04x} is not UTF-8; save the file as UTF-8"
        ) from None
    if "\0" in text:
        raise MeasurementError(path, text[: text.index("\0")].count("\n") + 1, "holds a NUL byte")
    kept, numbers = [], []
    for number, row in enumerate(text.splitlines(), 1):
        if row.strip() and not row.lstrip().startswith("#"):
            kept.append(row)
            numbers.append(number)
    if len(kept) > LARGEST_ROWS:
        raise MeasurementError(path, None, f"{len(kept)} rows; at most {LARGEST_ROWS} are read")
    return kept, numbers


def _columns(path: Path, line: int, header: list[str]) -> list[_ReadColumn | None]:
    if len(header) == 1 and (";" in header[0] or "\t" in header[0]):
        raise MeasurementError(path, line, "columns must be separated by commas")
    columns = [_column(path, line, h) for h in header]
    seen: dict[str, str] = {}
    for h, c in zip(header, columns, strict=True):
        key = c.name if c else h
        if key in seen:
            same = "twice" if seen[key] == h else f"as {seen[key]} and as {h}"
            raise MeasurementError(path, line, f"column {key} appears {same}")
        seen[key] = h
    return columns


def _column(path: Path, line: int, name: str) -> _ReadColumn | None:
    if name in LABELS or name in PLAIN or "." in name:
        return _ReadColumn(name)
    for quantity in sorted(QUANTITIES, key=len, reverse=True):
        unit, factors = QUANTITIES[quantity]
        if name != quantity and not name.startswith(quantity + "_"):
            continue
        given = name[len(quantity) + 1 :]
        if given not in factors:
            accepted = ", ".join(f"{quantity}_{u}" for u in factors)
            raise MeasurementError(path, line, f"column {name}: accepted are {accepted}")
        shift = -KELVIN_AT_0_C if given == "K" else 0.0
        return _ReadColumn(f"{quantity}_{unit}", factors[given], shift)
    return None


def _numbers(path: Path, name: str, texts: list[str], line: np.ndarray) -> np.ndarray:
    try:
        found = np.array([float(t) for t in texts])
    except ValueError:
        found = None
    if found is not None and np.isfinite(found).all() and not any("_" in t for t in texts):
        return found
    for text, number in zip(texts, line, strict=True):
        try:
            good = isfinite(float(text)) and "_" not in text
        except ValueError:
            good = False
        if not good:
            what = "is empty" if not text else f'= "{text[:40]}" is not a finite number'
            raise MeasurementError(path, int(number), f"{name} {what}")
    raise AssertionError("unreachable: one of the texts is no number")
