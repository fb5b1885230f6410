"""Words in the heads of columns, English and German, and what they say of a quantity."""

from __future__ import annotations


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_QUANTITIES = {
    "torque": "torque drehmoment moment torsionsmoment",
    "angle": "angle winkel twist verdrehung verdrehwinkel torsionswinkel drehwinkel rotation "
    "position encoder deflection displacement",
    "time": "time zeit timestamp datetime date datum uhrzeit zeitstempel elapsed",
    "temperature": "temperature temperatur temp",
    "stiffness": "stiffness steifigkeit torsionssteifigkeit",
    "cycle": "cycle cycles zyklus zyklen loop",
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
    "steifigkeit": "stiffness", "position": "angle",
}  # fmt: skip
"""Ends of German compounds; what stands before them qualifies."""
SAYS_NOTHING = _words(
    "output abtrieb abtriebs abtriebsseitig ausgang ausgangs actual act ist istwert measured gemessen "
    "mess messwert value wert reading signal no nr nummer number num s n in of the des der angular "
    "torsion torsional torsions rotational spring degree dreh verdreh test prüf lauf"
)
INPUT = _words("input motor antrieb antriebs eingang eingangs wave generator wg drive")
"""The wave generator's side."""
ANOTHER = _words(
    "setpoint set sp soll sollwert command commanded cmd target demand reference ref limit rate speed "
    "velocity acceleration error fehler std deviation abweichung min max minimum maximum offset zero "
    "range predicted simulated calculated computed model fitted fit type id nominal rated power "
    "current voltage strom spannung leistung drehzahl beschleunigung "
    "change rise delta δ diff difference differenz änderung increment step remaining half double "
    "x per pro div milli micro mikro kilo"
)
"""Words that make of a quantity another one, or scale it."""
OTHER_TIMES = _words("step remaining left")
"""Of a time: the others of `ANOTHER` leave it one, as in "Time 1 - default sample rate"."""
SPREAD = _words("std sd standard deviation standardabweichung abweichung")
PLUS = _words("plus + pos positive positiv")
MINUS = _words("minus - − neg negative negativ")
