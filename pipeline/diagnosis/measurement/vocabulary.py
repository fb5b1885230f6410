"""Words in the heads of columns, and what they say: English, German, Czech, Chinese, Japanese."""

from __future__ import annotations


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_QUANTITIES = {
    "torque": "torque drehmoment moment torsionsmoment 扭矩 转矩 力矩 トルク",
    "angle": "angle winkel twist verdrehung verdrehwinkel torsionswinkel drehwinkel rotation "
    "position encoder deflection displacement úhel uhel natočení natoceni 角度 转角 扭转角 回転角",
    "time": "time zeit timestamp datetime date datum uhrzeit zeitstempel elapsed čas cas 时间 時間",
    "temperature": "temperature temperatur temp teplota 温度",
    "stiffness": "stiffness steifigkeit torsionssteifigkeit tuhost 刚度 剛性",
    "cycle": "cycle cycles zyklus zyklen loop cyklus 循环 サイクル",
    "unit": "unit gear prüfling seriennummer serial sn",
    "specimen": "specimen probe",
    "part": "part bauteil",
}
QUANTITY_OF = {word: quantity for quantity, words in _QUANTITIES.items() for word in words.split()}
"""The quantity that a word names."""
SYMBOLS = {
    "torque": _words("m t md mt tq"),
    "angle": _words("phi φ ϕ theta θ ϑ alpha α"),
    "time": _words("t"),
    "temperature": _words("t theta θ ϑ"),
}
"""Letters that stand for a quantity where the unit says the same: T in N·m, °C and s."""
ENDINGS = {
    "moment": "torque", "winkel": "angle", "temperatur": "temperature", "zeit": "time",
    "steifigkeit": "stiffness", "position": "angle", "扭矩": "torque", "转矩": "torque", "力矩": "torque",
    "トルク": "torque", "角度": "angle", "转角": "angle", "回転角": "angle", "时间": "time", "時間": "time",
    "温度": "temperature", "刚度": "stiffness", "剛性": "stiffness",
}  # fmt: skip
"""Ends of compounds, which some languages write as one word; what stands before them qualifies."""
SAYS_NOTHING = _words(
    "output abtrieb abtriebs abtriebsseitig ausgang ausgangs actual act ist istwert measured gemessen "
    "mess messwert value wert reading signal no nr nummer number num s n in of the des der angular "
    "torsion torsional torsions rotational spring degree dreh verdreh test prüf lauf "
    "výstup výstupní vystup vystupni kroutící krouticí točivý tocivy torzní torzni naměřený "
    "naměřená měřený číslo 输出 输出端 测量 实测 扭转 编号 出力 出力側 測定"
)
INPUT = _words(
    "input motor antrieb antriebs eingang eingangs wave generator wg drive vstup vstupní vstupni motoru "
    "输入 输入端 电机 入力 入力側 モータ モーター"
)
"""The wave generator's side."""
ANOTHER = _words(
    "setpoint set sp soll sollwert command commanded cmd target demand reference ref limit rate speed "
    "velocity acceleration error fehler std deviation abweichung min max minimum maximum offset zero "
    "range predicted simulated calculated computed model fitted fit type id nominal rated power "
    "current voltage strom spannung leistung drehzahl beschleunigung "
    "change rise delta δ diff difference differenz änderung increment step remaining half double "
    "x per pro div milli micro mikro kilo "
    "žádaný žádaná zadaný zadaná rychlost otáčky chyba odchylka 设定 指令 目标 额定 速度 误差 目標 誤差 定格"
)
"""Words that make of a quantity another one, or scale it."""
OTHER_TIMES = _words("step remaining left")
"""Of a time: the others of `ANOTHER` leave it one, as in "Time 1 - default sample rate"."""
SPREAD = _words("std sd standard deviation standardabweichung abweichung")
PLUS = _words("plus + pos positive positiv")
MINUS = _words("minus - − neg negative negativ")
