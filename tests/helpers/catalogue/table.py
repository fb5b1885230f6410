"""Catalogue rows: three slopes of the torque-twist curve, and how finely they are printed."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError

K_UNIT = 1e4
"""The file's K are in 1e4 N·m/rad."""
SLOPES = ("K1_1e4_Nm_per_rad", "K2_1e4_Nm_per_rad", "K3_1e4_Nm_per_rad")


@dataclass(frozen=True)
class CatalogueRow:
    """Nominal averages of one size and ratio class, not of one unit.

    Attributes
    ----------
    T1, T2 : torques [N·m] at which the slope changes. K : K1, K2, K3 [N·m/rad].
    printed : steps [N·m/rad] of the printed K.
    """

    size: int
    ratio_class: str
    T1: float
    T2: float
    K: tuple[float, float, float]
    printed: tuple[float, float, float]


def twist_rad(row: CatalogueRow, torque_Nm: float | np.ndarray) -> np.ndarray:
    """Twist at T ≥ 0: T1/K1 + (T2 − T1)/K2 + (T − T2)/K3 above T2, and its parts below [rad].

    Source: Harmonic Drive SE, HFUS-2A engineering data 1019658 11/2014, p. 24.

    Examples
    --------
    The page's worked example, size 32, ratio 100, 60 N·m, "7.15e-4 rad":

    >>> row = CatalogueRow(32, ">50", 29.0, 108.0, (6.7e4, 1.1e5, 1.2e5), (1e3, 1e4, 1e4))
    >>> round(float(twist_rad(row, 60.0)), 6)
    0.000715
    """
    T = np.asarray(torque_Nm, float)
    first = np.minimum(T, row.T1)
    second = np.clip(T, row.T1, row.T2) - row.T1
    third = np.maximum(T, row.T2) - row.T2
    return first / row.K[0] + second / row.K[1] + third / row.K[2]


def read_catalogue(path: Path) -> tuple[CatalogueRow, ...]:
    """Rows whose three slopes are all known; those without K3 are left out.

    Raises
    ------
    MeasurementError : a row that is not numbers.
    """
    found = []
    with path.open(encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        for line in reader:
            texts = [line[name].strip() for name in SLOPES]
            if not all(texts):
                continue
            try:
                K1, K2, K3 = (float(t) * K_UNIT for t in texts)
                p1, p2, p3 = (10.0 ** -len(t.partition(".")[2]) * K_UNIT for t in texts)
                row = CatalogueRow(
                    int(line["size"]), line["ratio_class"].split()[0], float(line["T1_Nm"]),
                    float(line["T2_Nm"]), (K1, K2, K3), (p1, p2, p3),
                )  # fmt: skip
            except (ValueError, KeyError) as fault:
                raise MeasurementError(path, reader.line_num, str(fault)) from None
            found.append(row)
    return tuple(found)
