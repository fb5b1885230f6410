"""The keys of extended_model.toml, and whether a table holds just these, each of its type."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from flexspline.pipeline.diagnosis.measurement.errors import ModelFileError
from flexspline.pipeline.diagnosis.measurement.table import LARGEST_NUMBER

Refuse = Callable[[str], ModelFileError]
Keys = dict[str, tuple[type, ...]]
NUMBER = (int, float)
TOP: Keys = {"format": (int,), "provenance": (dict,), "calibrated": (dict,), "unit": (list,)}
TOP_OPTIONAL: Keys = {"cause": (list,), "doubt": (dict,), "bend": (dict,)}
BEND: Keys = {"torque_Nm": (list,), "angle_arcsec": (list,)}
PROVENANCE: Keys = {
    "program": (str,), "design": (str,), "measurement": (str,), "measurement_sha256": (str,),
    "verdict": (str,), "K_b_Nm_per_rad": NUMBER, "K_e_Nm_per_rad": NUMBER,
    "time_recorded": (bool,),
}  # fmt: skip
PROVENANCE_OPTIONAL: Keys = {"gain": (dict,), "design_digests": (dict,)}
CALIBRATED: Keys = {"compliance_arcsec_per_Nm": NUMBER, "gap_arcsec": NUMBER}
UNIT: Keys = {"name": (str,), "zero_arcsec": NUMBER}
OWN: Keys = {"own_compliance_arcsec_per_Nm": NUMBER, "own_gap_arcsec": NUMBER}
ORIGIN: Keys = {"first_cycle": NUMBER, "first_time_s": NUMBER}
CAUSE: Keys = {"id": (str,), "element": (list,)}
CAUSE_OPTIONAL: Keys = {
    "title": (str,), "magnitude": NUMBER, "magnitude_std": NUMBER, "unit": (str,),
    "alternatives": (list,), "ahead_of_gap_std_Nm": NUMBER,
}  # fmt: skip
ELEMENT: Keys = {"amplitudes": (list,), "shape": (dict,)}
GAIN: Keys = {
    "held_out": (str,), "rmse_before": NUMBER, "rmse_calibrated": NUMBER, "rmse_after": NUMBER,
    "noise_floor": NUMBER, "unit": (str,),
}  # fmt: skip
DOUBT: Keys = {
    "reading_arcsec": NUMBER, "torque_noise_Nm": NUMBER, "covariance": (list,), "measured": (dict,),
}  # fmt: skip
DOUBT_OPTIONAL: Keys = {"crossing_Nm": NUMBER}
MEASURED: Keys = {"torque_Nm": (list,)}
MEASURED_OPTIONAL: Keys = {
    "smallest_loop_Nm": NUMBER, "rate_Nm_per_s": NUMBER, "slowest_rate_Nm_per_s": NUMBER,
    "temperature_C": (list,), "input_angle_deg": (list,),
}  # fmt: skip
NAMES = {int: "a whole number", str: "text", bool: "true or false", list: "a list", dict: "a table"}


def tables(values: list, name: str, refuse: Refuse) -> list[dict[str, Any]]:
    """The values, each of which is a table."""
    if not all(isinstance(v, dict) for v in values):
        raise refuse(f"{name} must be tables [[{name}]]")
    return values


def check(
    table: Mapping[str, Any], needed: Keys, optional: Keys, where: str, refuse: Refuse
) -> None:
    """All needed keys, none unknown, each of its type and finite."""
    for key in needed:
        if key not in table:
            raise refuse(f"{key} is missing in {where}")
    known = needed | optional
    for key, value in table.items():
        if key not in known:
            raise refuse(f"{key} is not a key of {where}; it takes {', '.join(known)}")
        wanted = known[key]
        right = isinstance(value, wanted) and (bool in wanted or not isinstance(value, bool))
        if not right:
            words = "a number" if wanted == NUMBER else NAMES[wanted[0]]
            raise refuse(f"{key} in {where} must be {words}")
        if isinstance(value, float | int) and not is_number(value) and bool not in wanted:
            raise refuse(f"{key} in {where} must be a number within ±{LARGEST_NUMBER:g}")


def is_number(value: object) -> bool:
    """Also: one that no reading exceeds; whole numbers of TOML may have any length."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= LARGEST_NUMBER  # false for NaN
