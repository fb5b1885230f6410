"""Words in column headings and their meaning: English, German, Czech, Chinese, Japanese."""

from __future__ import annotations

import re


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_QUANTITIES = {
    "torque": "torque drehmoment moment torsionsmoment 扭矩 转矩 力矩 トルク",
    "angle": "angle winkel twist verdrehung verdrehwinkel torsionswinkel drehwinkel rotation position "
    "encoder deflection displacement úhel uhel natočení natoceni zkroucení zkrut "
    "角度 转角 扭转角 扭角 旋转角 角位移 回転角 ねじれ角",
    "time": "time zeit timestamp datetime date datum uhrzeit zeitstempel elapsed čas cas 时间 时刻 時間",
    "temperature": "temperature temperatur temp teplota 温度 油温",
    "stiffness": "stiffness steifigkeit torsionssteifigkeit tuhost 刚度 剛性",
    "cycle": "cycle cycles zyklus zyklen loop durchgang durchlauf takt cyklus cyklu "
    "循环 循环次数 サイクル サイクル数",
    "unit": "unit gear prüfling einheit gerät getriebe exemplar seriennummer serial sn",
    "specimen": "specimen probe muster",
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
    "steifigkeit": "stiffness", "position": "angle",
}  # fmt: skip
"""Ends of German compounds; what stands before them qualifies."""
SAYS_NOTHING = _words(
    "output abtrieb abtriebs abtriebsseitig ausgang ausgangs actual act ist istwert measured gemessen "
    "mess messwert value wert reading signal no nr nummer number num s n in of the des der angular "
    "torsion torsional torsions rotational spring degree dreh verdreh test prüf lauf "
    "výstup výstupní výstupu výstupního vystup vystupni hřídele na v kroutící krouticí točivý tocivy torzní "
    "torzni naměřený naměřená měřený měřená číslo "
    "输出 输出端 输出轴 输出侧 轴 侧 端 负载 测量 测得 实测 实际 扭转 编号 序号 号 值 数 "
    "出力 出力側 出力軸 軸 側 の 負荷 測定 実測 値"
)
INPUT = _words(
    "input motor antrieb antriebs eingang eingangs wave generator wg drive "
    "vstup vstupní vstupni vstupu vstupního motoru motorový motorovy motorová generátoru generatoru vlnového "
    "输入 电机 电动机 马达 驱动 波发生器 波动发生器 入力 モータ モーター 電動機 駆動 ウェーブジェネレータ"
)
"""The wave generator's side."""
ANOTHER = _words(
    "setpoint set sp soll sollwert command commanded cmd target demand reference ref limit rate speed "
    "velocity acceleration error fehler std deviation abweichung min max minimum maximum offset zero "
    "range predicted simulated calculated computed model fitted fit type id nominal rated power "
    "current voltage strom spannung leistung drehzahl beschleunigung "
    "change rise delta δ diff difference differenz änderung increment step remaining half double "
    "x per pro div milli micro mikro kilo "
    "žádaný žádaná zadaný zadaná požadovaný požadovaná nastavený nastavená cílový cílová jmenovitý jmenovitá "
    "maximální minimální třecí rychlost otáčky chyba odchylka směrodatná "
    "设定 给定 指令 命令 目标 期望 额定 最大 最小 峰值 平均 速度 加速度 转速 误差 偏差 标准差 标准偏差 "
    "摩擦 启动 变化 率 增量 差 零点 零位 理论 计算 仿真 电流 电压 功率 "
    "設定 目標 定格 回転数 誤差 標準偏差 起動 変化 計算 電流 電圧"
)
"""Words that make of a quantity another one, or scale it."""
OTHER_TIMES = _words("step remaining left zbývající 剩余 间隔 采样 残り 間隔 サンプリング")
"""Of a time: the others of `ANOTHER` leave it one, as in "Time 1 - default sample rate"."""
STD_WORDS = _words(
    "std sd standard deviation standardabweichung abweichung směrodatná odchylka 标准差 标准偏差 標準偏差"
)
PLUS = _words("plus + pos positive positiv")
MINUS = _words("minus - − neg negative negativ")

EASTERN = re.compile("[぀-ヿ㐀-鿿]")
"""Letters of Japanese and Chinese, which have no spaces between words."""
_EVERY = QUANTITY_OF.keys() | SAYS_NOTHING | INPUT | ANOTHER | OTHER_TIMES | STD_WORDS
EASTERN_WORDS = re.compile(f"({'|'.join(sorted(filter(EASTERN.search, _EVERY), key=len)[::-1])})")
"""Known words in those letters, the longest first: a head is cut into them."""
