"""Names of a record's channels and of design keys in words: the one table of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from flexspline.geometry.listed import listed
from flexspline.geometry.schema import key_words
from flexspline.pipeline.diagnosis.left_out import LeftOut


@dataclass(frozen=True)
class ChannelWords:
    """A channel in words.

    Attributes
    ----------
    name : in a sentence. unit : of its values, "" of none. axis : its name on an axis, where it is another.
    level : its name before the value of a level, and digits : the format of that value.
    many : what its values are called where they are counted.
    """

    name: str
    unit: str = ""
    axis: str = ""
    level: str = ""
    digits: str = ""
    many: str = ""

    @property
    def label(self) -> str:
        """Of an axis."""
        name = self.axis or self.name
        return f"{name} in {self.unit}" if self.unit else name


CHANNELS: Mapping[str, ChannelWords] = {
    "torque_Nm": ChannelWords("torque", "N·m", axis="output torque"),
    "angle": ChannelWords("output angle"),
    "angle_arcsec": ChannelWords("output angle", "arcsec"),
    "specimen": ChannelWords("further specimens", many="specimens"),
    "specimen_order": ChannelWords("the order of the specimens"),
    "repeat": ChannelWords("repetition"),
    "sweep": ChannelWords("a closed sweep"),
    "direction": ChannelWords("direction of loading"),
    "cycle": ChannelWords("load cycle", many="cycles"),
    "time_s": ChannelWords("time", "s"),
    "row": ChannelWords("the order of the rows"),
    "temperature_C": ChannelWords("temperature", "°C", level="temperature", digits=".1f"),
    "input_angle_deg": ChannelWords("wave generator angle", "°", many="positions"),
    "unit": ChannelWords("unit under test", many="units"),
    "torque_rate": ChannelWords("rate of torque", "N·m/s", level="rate", digits=".2g"),
    "torque_amplitude": ChannelWords("amplitude of torque", "N·m", level="amplitude", digits=".3g"),
    "hold": ChannelWords("holds at constant torque"),
}
"""By their keys in diagnosis.json."""


def channel_words(name: str) -> str:
    """A channel's name in words; a design key without its unit; an unknown one as it is."""
    if "." in name:
        return key_words(name)[0]
    return CHANNELS[name].name if name in CHANNELS else name


def left_out_words(left: LeftOut) -> str:
    """What was left out of a fit."""
    words = CHANNELS[left.channel]
    if left.each:
        return f"each of {left.each} {words.many} in turn"
    if left.level:
        low, high = (format(value, words.digits) for value in left.values)
        ends = low if low == high else f"{low} to {high}"
        return f"{words.level} {ends} {words.unit}"
    if left.of_units:
        by_unit = (
            f"{_counted(words, map(_plain, values))} of unit {unit}"
            for unit, values in left.of_units
        )
        return listed(by_unit, CHANNELS["unit"].many)
    return _counted(words, left.names or map(_plain, left.values))


def _plain(value: float) -> str:
    return f"{value:g}"


def _counted(words: ChannelWords, values: Iterable[str]) -> str:
    """Some of what a channel has many of, one by one."""
    shown = list(values)
    many = words.many if len(shown) > 1 else words.many.removesuffix("s")
    return f"{many} {listed(shown, words.many)}"
