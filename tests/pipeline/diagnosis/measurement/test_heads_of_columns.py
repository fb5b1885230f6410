"""What the heads of columns say: names, units, and what is none of ours."""

from __future__ import annotations

import pytest

from flexspline.pipeline.diagnosis.measurement.column_names import column_name
from flexspline.pipeline.diagnosis.measurement.units import QUANTITIES

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
    "torque_m_Nm": ("torque", "Nm"), "torque_m-Nm": ("torque", "Nm"),
    "Kroutící moment [N·m]": ("torque", "Nm"), "Úhel natočení (°)": ("angle", "deg"),
    "Vstupní úhel [°]": ("input_angle", "deg"), "Čas [s]": ("time", "s"),
    "Teplota [°C]": ("temperature", "C"),
    "扭矩（N·m）": ("torque", "Nm"), "输出转角 [°]": ("angle", "deg"), "输入角度[°]": ("input_angle", "deg"),
    "扭矩［Ｎｍ］": ("torque", "Nm"),
    "时间/s": ("time", "s"), "温度(℃)": ("temperature", "C"), "循环": ("cycle", None),
    "ねじれ角 (arcsec)": ("angle", "arcsec"), "入力軸回転角 (deg)": ("input_angle", "deg"),
    "波发生器角度 (deg)": ("input_angle", "deg"), "输出端角位移 (arcsec)": ("angle", "arcsec"),
    "úhel generátoru vln (deg)": ("input_angle", "deg"), "zkroucení (arcsec)": ("angle", "arcsec"),
    "ウェーブジェネレータ回転角 (deg)": ("input_angle", "deg"), "输出端扭转角 (arcsec)": ("angle", "arcsec"),
    "刚度 标准差 (Nm/rad)": ("stiffness_std", "Nm_per_rad"),
    "Angle (DEG)": ("angle", "deg"), "Angle [Deg]": ("angle", "deg"), "Angle (RAD)": ("angle", "rad"),
    "Time (SEC)": ("time", "s"), "TIME (MIN)": ("time", "min"),
    "TORQUE (KNM)": ("torque", "kNm"), "Torque (NMM)": ("torque", "Nmm"),
    "STIFFNESS [NM/RAD]": ("stiffness", "Nm_per_rad"),
    "输出角度(角秒)": ("angle", "arcsec"), "角度(角分)": ("angle", "arcmin"), "角度（度）": ("angle", "deg"),
    "角度(分)": ("angle", "arcmin"), "角度(秒)": ("angle", "arcsec"), "转角/弧度": ("angle", "rad"),
    "扭矩(牛·米)": ("torque", "Nm"), "扭矩[牛米]": ("torque", "Nm"), "扭矩(牛•米)": ("torque", "Nm"),
    "扭矩(牛顿·米)": ("torque", "Nm"), "扭矩(牛-米)": ("torque", "Nm"), "扭矩(千牛·米)": ("torque", "kNm"),
    "トルク(ニュートン・メートル)": ("torque", "Nm"),
    "时间(秒)": ("time", "s"), "时间(分)": ("time", "min"), "時間(秒)": ("time", "s"),
    "时间(毫秒)": ("time", "ms"), "油温(度)": ("temperature", "C"),
    "Einheit": ("unit", None), "Gerät": ("unit", None), "Getriebe": ("unit", None),
    "Exemplar": ("unit", None), "Muster": ("specimen", None), "Probe": ("specimen", None),
    "Durchgang": ("cycle", None), "Takt": ("cycle", None), "Takt-Nr.": ("cycle", None),
    "出力トルク [Nm]": ("torque", "Nm"), "回転角 [deg]": ("angle", "deg"), "時間 [s]": ("time", "s"),
}  # fmt: skip
WRITTEN = {
    "Nm": "Nm N.m N*m N·m N-m N−m N_m N・m N•m NM newton-metres",
    "mNm": "mNm mN.m mN·m mN-m", "kNm": "kNm kN.m kN-m", "Ncm": "Ncm N.cm cN.m", "uNm": "µNm uN-m",
    "daNm": "daNm daN·m",
    "in_lbf": "in-lbf in_lbf lbf.in in*lbf lbf·in in-lb in-lbs lb-in inlb in.-lb lbf-in. IN-LBF inch-pounds "
    "pound-inches",
    "ft_lbf": "ft-lbf ft.lbf lbf*ft ft-lb ft-lbs lb-ft lbft foot-pounds FT-LBS",
    "in_ozf": "oz-in ozf.in in-oz ozin ounce-inches OZ-IN",
    "kgf_m": "kgf-m kgf·m kgf.m kgm kp·m", "kgf_cm": "kgf.cm kgf-cm kg-cm kgcm kp·cm", "kgf_mm": "kgf·mm",
    "gf_cm": "gf·cm g-cm",
    "deg": "deg deg. ° degrees", "rad": "rad rads", "mrad": "mrad", "urad": "µrad μrad urad microradians",
    "arcmin": "arcmin arc-min ' ′ arcmin.", "arcsec": 'arcsec arc-sec " ″ \'\' ′′ arcsec.',
    "rev": "rev revs rev. turns turn revolutions Umdrehungen",
}  # fmt: skip
"""How programs, catalogues and people write each unit; a space is none of it here."""
IN_WORDS = {
    "Torque (in lbf)": "in_lbf", "Torque, ft lbs": "ft_lbf", "Torque / oz in": "in_ozf",
    "Drehmoment in in-lbf": "in_lbf", "torque_in-lbf": "in_lbf", "torque_kgf_cm": "kgf_cm",
    "Torque [in. lb]": "in_lbf", "Angle (arc min)": "arcmin", "Angle [sec of arc]": "arcsec",
}  # fmt: skip
NOT_OURS = (
    "Motor torque [Nm]", "Torque setpoint [Nm]", "Soll-Winkel [°]", "Angle rate [deg/s]", "Cycle time [s]",
    "设定扭矩 [Nm]", "Žádaný moment [Nm]", "输入扭矩 [Nm]", "扭矩设定值 (Nm)",
    "电动机转矩 (Nm)", "马达扭矩 [Nm]", "モータ側トルク [Nm]", "入力軸トルク [Nm]", "motorový moment [Nm]",
    "moment na vstupu [Nm]", "给定扭矩 [Nm]", "設定トルク [Nm]", "požadovaný moment [Nm]", "最大扭矩 [Nm]",
    "摩擦力矩 [Nm]", "サイクル時間 (s)", "čas cyklu (s)", "剩余时间 (s)", "残り時間 (s)",
    "扭转角 标准差 (arcsec)", "角速度 [deg/s]", "仿真转角 [arcsec]",
    "Torque (Min)", "Torque Min", "Angle (MAX)", "Taktzeit [s]", "Zykluszeit [s]",
    "Comment", "Part No.", "1.25", "", "angle_predicted_arcsec", "Torque;Angle", "Drehzahl [1/min]",
)  # fmt: skip
NO_UNIT = {
    "torque": "", "Drehmoment": "", "torque_lbf": "lbf", "Torque [lbf]": "lbf",
    "Torque [kg]": "kg", "Torque [lb/in]": "lb/in", "Torque [m-N]": "m-N", "angle_min": "min",
    "Time [MS]": "MS",
    "Angle [grad]": "grad", "Temp [F]": "F", "Torque [deg]": "deg", "Torque [MNm]": "MNm",
    "Torque [MN-m]": "MN-m", "Torque (MNM)": "", "Torque [MNM]": "MNM", "Angle [GRAD]": "GRAD",
    "角度[角X]": "角X",
}  # fmt: skip
"""Quantities whose unit is missing or none: grad is degrees or gon, MNm no small gear's."""


@pytest.mark.parametrize("head", SAID)
def test_a_quantity_and_its_unit(head: str) -> None:
    found = column_name(head)
    assert found is not None
    assert (found.quantity, found.unit) == SAID[head]
    assert found.strange is None


@pytest.mark.parametrize(
    ("written", "unit"), [(way, unit) for unit, ways in WRITTEN.items() for way in ways.split()]
)
def test_every_way_of_writing_a_unit_is_read(written: str, unit: str) -> None:
    quantity = "torque" if unit in QUANTITIES["torque"].factors else "angle"
    for head in (f"{quantity} [{written}]", f"{quantity} ({written})", f"{quantity} / {written}"):
        found = column_name(head)
        assert found is not None
        assert (found.quantity, found.unit) == (quantity, unit), head


@pytest.mark.parametrize("head", IN_WORDS)
def test_units_of_two_words_are_read_beside_others(head: str) -> None:
    found = column_name(head)
    assert found is not None
    assert found.unit == IN_WORDS[head]


@pytest.mark.parametrize("head", NOT_OURS)
def test_other_columns_are_left(head: str) -> None:
    assert column_name(head) is None


@pytest.mark.parametrize("head", NO_UNIT)
def test_a_unit_is_never_supposed(head: str) -> None:
    found = column_name(head)
    assert found is not None
    assert found.unit is None
    assert (found.strange or "") == NO_UNIT[head]
