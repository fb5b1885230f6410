"""What a refusal advises works: typed in as printed it is accepted, or another key is refused next."""

from __future__ import annotations

import math
import re
import tomllib
from collections import Counter
from typing import Any

import numpy as np
import pytest
from random_designs import SLIPS, design_of

from flexspline.geometry.bounds import beside, from_zero, outside, span
from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import design_from
from flexspline.geometry.template import template

REFUSALS = 600
STEPS = 8
NUMBER = r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
FACTORS = (0.0, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99, 1.01, 1.1, 2.0, 10.0, 25.4, 100.0, 1e4)
"""Slips of units and of the pen, and values close by."""
BY_THE_GEAR = ("flexspline.inner_diameter_mm",)
"""Whose largest value the flexspline tells and whose least the gear: each rule names its own end."""
AGAIN_BEFORE = (990039, 990145, 990888, 991409, 992273, 992729, 993058, 995839)
"""Designs that were told an end refused again, of every rule of which that was so; or a range "None"."""


def numbers_in(tables: Any) -> list[tuple[Any, Any]]:
    """(container, key) of every number."""
    found: list[tuple[Any, Any]] = []
    for key, value in tables.items() if isinstance(tables, dict) else enumerate(tables):
        if isinstance(value, dict | list):
            found += numbers_in(value)
        elif isinstance(value, int | float) and not isinstance(value, bool):
            found.append((tables, key))
    return found


def mutated(seed: int) -> dict[str, Any]:
    """A random design with one to three of its numbers changed."""
    rng = np.random.default_rng([14, seed])
    tables = design_of(seed, slips=False)
    places = numbers_in(tables)
    for _ in range(int(rng.integers(1, 4))):
        table, key = places[int(rng.integers(len(places)))]
        if not isinstance(table.get(key), int | float):  # changed before
            continue
        if rng.random() < 0.2:
            kind = int(rng.integers(3))
            if kind == 0:
                table[f"{key[:-4]}x{key[-4:]}"] = table.pop(key)
            elif kind == 1:
                del table[key]
            else:
                table[key] = SLIPS[int(rng.integers(len(SLIPS)))]
            continue
        value = table[key] * float(rng.choice(FACTORS))
        whole = isinstance(table[key], int) and math.isfinite(value)
        table[key] = round(value) if whole else value
    return tables


def place_of(tables: Any, key: str) -> tuple[Any, Any]:
    """Container and last part of a dotted key; tables on the way are made."""
    parts: list[str | int] = []
    for name in key.split("."):
        match = re.fullmatch(r"(\w+)\[(\d+)\]", name)
        parts += [match[1], int(match[2])] if match else [name]
    for part in parts[:-1]:
        if isinstance(part, str) and not isinstance(tables.get(part), dict | list):
            tables[part] = {}
        tables = tables[part]
    return tables, parts[-1]


def advised(line: str, value: object) -> object:
    """The number that a refusal names nearest to the value, as printed."""
    advice = re.split(r"it must be|(?:needs it; )?give|must be", line, maxsplit=1)[1].partition(
        ":"
    )[0]
    advice = re.sub(r"\([^)]*\)", "", advice)
    ends = [n for pair in re.findall(rf"from ({NUMBER}) to ({NUMBER})", advice) for n in pair]
    rest = re.sub(rf"from {NUMBER} to {NUMBER}", "", advice)
    ends += re.findall(rf"(?:be|to|or|,|^)\s*({NUMBER})(?=\s|,|$)", rest.replace("equal to", "or"))
    assert ends, line
    is_number = isinstance(value, int | float) and value == value
    near = max(-1e9, min(1e9, value)) if is_number else 0.0
    best = min(ends, key=lambda e: abs(float(e) - near) if is_number else 0.0)
    return int(best) if re.fullmatch(r"\d+", best) and "whole" in line else float(best)


def follow(tables: dict[str, Any], error: DesignError) -> None:
    """Do what the line says."""
    line = str(error)
    if re.search(r"unknown key|belongs to a|must be left out", line):
        table, key = place_of(tables, error.key)
        del table[key]
        return
    base = tomllib.loads(template("hat" if "flange" in str(tables.get("flexspline")) else "cup"))
    table, key = place_of(tables, error.key)
    if 'must be "' in line or 'give "' in line:
        table[key] = re.findall(
            r'"(\w+)"', line.partition('must be "')[1] + line.partition("must be ")[2]
        )[0]
    elif re.search(r"text of|one line of text|not blank", line):
        table[key] = "x"
    elif re.search(r"(must be|give) (a table|\d+ to \d+ tables)", line):
        there, name = place_of(base, error.key)
        table[key] = there[name]
    else:
        given = advised(line, error.value)
        whole = "bolt_count" in error.key or "teeth" in error.key
        table[key] = int(given) if whole else given


def settled(tables: dict[str, Any]) -> list[str]:
    """Refusals on the way to an accepted design."""
    lines: list[str] = []
    keys: list[str] = []
    while (error := refusal(tables)) is not None:
        assert not keys or error.key != keys[-1], (lines, str(error))
        keys.append(error.key)
        lines.append(str(error))
        follow(tables, error)
    return lines


def refusal(tables: dict[str, Any]) -> DesignError | None:
    try:
        design_from(tables)
    except DesignError as error:
        return error
    return None


def test_following_the_advice_ends() -> None:
    refusals, longest, seen = 0, 0, Counter[str]()
    seed = 0
    while refusals < REFUSALS:
        lines = settled(mutated(seed))
        refusals += len(lines)
        longest = max(longest, len(lines))
        seen.update(re.sub(r"\[\d\]", "[i]", s.partition(" ")[0]) for s in lines)
        seed += 1
    assert longest <= STEPS
    assert len(seen) > 25, seen  # of the kinds of keys that there are


def refused_again(seed: int) -> list[str]:
    """Ends of the ranges that a refusal names, typed in, for which the same key is refused."""
    tables = mutated(seed)
    error = refusal(tables)
    if error is None or "must be from" not in error.alone or error.key in BY_THE_GEAR:
        return []
    assert "None" not in error.alone, error.alone
    advice = re.sub(r"\([^)]*\)", "", error.reason.partition(":")[0])
    table, key = place_of(tables, error.key)
    found = []
    for end in (n for pair in re.findall(rf"from ({NUMBER}) to ({NUMBER})", advice) for n in pair):
        whole = "bolt_count" in error.key or "teeth" in error.key
        table[key] = int(end) if whole else float(end)
        again = refusal(tables)
        if again is not None and again.key == error.key:
            found.append(f"{seed}: {error.alone}; then {again.alone}")
    return found


def test_both_ends_of_a_range_work() -> None:
    numbers = [*AGAIN_BEFORE, *range(996_000, 998_000)]
    assert not [line for seed in numbers for line in refused_again(seed)]


def test_ends_are_rounded_inwards() -> None:
    assert span(0, 4.504113) == "from 0 to 4.50411"
    assert (
        span(2.0000001, 2.00000016) == "from 2.0000001 to 2.0000001"
    )  # as many digits as it takes
    assert span(0.0, -1.8e-7) is None
    assert from_zero(-1.8e-7) == "0"
    assert from_zero(0.0004) == "0"  # a micrometre is the least
    rng = np.random.default_rng(1)
    for low, width in zip(rng.uniform(0, 1e4, 500), 10 ** rng.uniform(-9, 3, 500), strict=True):
        text = span(low, low + width)
        if text is None:
            continue
        first, last = (float(t) for t in text.removeprefix("from ").split(" to "))
        assert low <= first <= last <= low + width


def test_beside_and_outside() -> None:
    assert (
        beside(20.0, "x", 0.002, 17.0, 1e4) == "20 (x), from 17 to 19.998 or from 20.002 to 10000"
    )
    assert beside(0.0, "x", 0.002, 0.0, 5.0, zero=True) == "0 (x) or from 0.002 to 5"
    assert beside(0.1 + 0.2, "x", 0.5, 0.1, 5.0) == "exactly x or from 0.8 to 5"
    assert outside([(1.0, 2.0), (1.5, 3.0)], 0.0, 5.0) == [(0.0, 1.0), (3.0, 5.0)]


EMPTY = [
    ("flexspline", "boss_diameter_mm", 38.3999, "flexspline.inner_fillet_mm", "flexspline.boss_diameter_mm"),
    ("flexspline", "ring_width_mm", 29.4, "flexspline.inner_fillet_mm", "flexspline.ring_width_mm"),
]  # fmt: skip


@pytest.mark.parametrize(("table", "key", "value", "refused", "named"), EMPTY)
def test_an_empty_range_names_another_key_and_how_far(
    table: str, key: str, value: float, refused: str, named: str
) -> None:
    tables = tomllib.loads(template("cup"))
    tables[table][key] = value
    with pytest.raises(DesignError) as caught:
        design_from(tables)
    assert caught.value.key == refused
    assert "must be 0 mm to fit" in str(caught.value)
    found = re.search(
        rf"change {re.escape(named)} to ({NUMBER}) mm or less",
        str(caught.value),
    )
    assert found is not None, str(caught.value)
    tables[table][key] = float(found[1])
    design_from(tables)
