"""What the heads of columns say: names, units, and what is none of ours."""

from __future__ import annotations

import pytest

from flexspline.pipeline.diagnosis.measurement.column_names import column_name

SAID = {
    "torque_Nm": ("torque", "Nm"), "Torque [Nm]": ("torque", "Nm"), "Torque (N·m)": ("torque", "Nm"),
    "Torque, Nm": ("torque", "Nm"), "M/Nm": ("torque", "Nm"), "T / N m": ("torque", "Nm"),
    "Drehmoment in Nm": ("torque", "Nm"), "Abtriebsmoment [N m]": ("torque", "Nm"),
    "TORQUE [NM]": ("torque", "Nm"), "torque_N_m": ("torque", "Nm"), "Torque[mNm]": ("torque", "mNm"),
    "torque (kN·m)": ("torque", "kNm"), "Torque CH1 [Ncm]": ("torque", "Ncm"),
    "Winkel [°]": ("angle", "deg"), 'Winkel ["]': ("angle", "arcsec"), "Winkel [′]": ("angle", "arcmin"),
    "Angle (arc sec)": ("angle", "arcsec"), "angle [arc-sec]": ("angle", "arcsec"),
    "φ [mrad]": ("angle", "mrad"),
    "Abtriebswinkel [Grad]": ("angle", "deg"), "Output angle [deg]": ("angle", "deg"),
    "angle µrad": ("angle", "urad"), "Twist angle [arcsec]": ("angle", "arcsec"),
    "Encoder [counts]": ("angle", "counts"), "Winkel [Inkremente]": ("angle", "counts"),
    "Input angle [deg]": ("input_angle", "deg"), "Motorwinkel [°]": ("input_angle", "deg"),
    "Wave generator angle (deg)": ("input_angle", "deg"),
    "Angle + [arcsec]": ("angle_plus", "arcsec"), "Winkel - [arcmin]": ("angle_minus", "arcmin"),
    "T [°C]": ("temperature", "C"), "Temp. [K]": ("temperature", "K"),
    "Oil temperature [degC]": ("temperature", "C"),
    "t [s]": ("time", "s"), "Zeit [ms]": ("time", "ms"), "Elapsed time (sec)": ("time", "s"),
    "Zeit/min": ("time", "min"),
    "Timestamp": ("time", None), "Datum": ("time", None), "Cycle No.": ("cycle", None),
    "Zyklus-Nr.": ("cycle", None),
    "Serial No.": ("unit", None), "Stiffness [Nm/rad]": ("stiffness", "Nm_per_rad"),
    "Steifigkeit [Nm/arcmin]": ("stiffness", "Nm_per_arcmin"),
    "Stiffness std [N·m/rad]": ("stiffness_std", "Nm_per_rad"),
    "flexspline.length_mm": ("flexspline.length_mm", None),
}  # fmt: skip
NOT_OURS = (
    "Motor torque [Nm]", "Torque setpoint [Nm]", "Soll-Winkel [°]", "Angle rate [deg/s]", "Cycle time [s]",
    "Comment", "Part No.", "1.25", "", "angle_predicted_arcsec", "Torque;Angle", "Drehzahl [1/min]",
)  # fmt: skip
NO_UNIT = {
    "torque": "", "Drehmoment": "", "torque_lbf": "lbf", "Torque [lbf·in]": "lbf·in", "angle_min": "min",
    "Angle [grad]": "grad", "Temp [F]": "F", "Torque [deg]": "deg", "Torque [MNm]": "MNm",
}  # fmt: skip
"""Quantities whose unit is missing or none: grad is degrees or gon, MNm no small gear's."""


@pytest.mark.parametrize("head", SAID)
def test_a_quantity_and_its_unit(head: str) -> None:
    found = column_name(head)
    assert found is not None
    assert (found.quantity, found.unit) == SAID[head]
    assert found.strange is None


@pytest.mark.parametrize("head", NOT_OURS)
def test_other_columns_are_left(head: str) -> None:
    assert column_name(head) is None


@pytest.mark.parametrize("head", NO_UNIT)
def test_a_unit_is_never_supposed(head: str) -> None:
    found = column_name(head)
    assert found is not None
    assert found.unit is None
    assert (found.strange or "") == NO_UNIT[head]
