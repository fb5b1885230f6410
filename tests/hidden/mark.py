"""Marks one diagnosis against the truth of its case."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from hidden.case import Case
from hidden.oracle import held_out_rows, oracle

Diagnose = Callable[[Case], dict]


NEAR = 2 / 5**0.5
"""Absorbed : left = 2 : 1, where docs/contract.md lets `named` stand beside what is unexplained."""


@dataclass(frozen=True)
class Size:
    """One true cause that was found: |found − true| / |true|, and the same in stated deviations."""

    cause: str
    error: float
    deviations: float


@dataclass(frozen=True)
class LevelGain:
    """Gain on a whole amplitude, rate or temperature that was held out, and the oracle's on the same rows."""

    channel: str
    gain: float
    oracle: float


@dataclass(frozen=True)
class Mark:
    """What became of a case; `right` is what its kind demands.

    first : named or ambiguous, and the first cause is a true one. exact : named, all of the
    truth and nothing else. wrong : named, with confidence, something that is not there; a cause
    whose own alternatives list a true one is not a confident name.
    near : a foreign effect of which one named cause absorbs more than twice what it leaves.
    seconds : per 3,000 rows where there are more.
    gain : share of the error above the noise removed; oracle : what the true form would remove.
    levels : the same of each amplitude, rate and temperature held out as a whole.
    again : shares of the rows of a second measurement within one and two stated deviations.
    """

    kind: str
    label: str
    severity: str
    decidable: bool
    seed: tuple[int, int]
    said: str
    standing: tuple[float, ...]
    verdict: str
    found: tuple[str, ...]
    alternatives: tuple[str, ...]
    first: bool
    exact: bool
    wrong: bool
    right: bool
    seconds: float
    sizes: tuple[Size, ...] = field(default=())
    gain: float | None = None
    oracle: float | None = None
    fault: str = ""
    near: bool = False
    levels: tuple[LevelGain, ...] = ()
    again: tuple[float, float] | None = None


def mark(case: Case, diagnose: Diagnose) -> Mark:
    """Run one diagnosis and mark it; an exception is a wrong answer that keeps its text."""
    wall, cpu = time.perf_counter(), time.process_time()
    try:
        said, fault = diagnose(case), ""
    except Exception:
        said, fault = {"verdict": "crashed"}, traceback.format_exc(limit=-4)
    # a busy machine must not fail a program, nor threads count twice; rows beyond 3,000 are more work
    seconds = min(time.perf_counter() - wall, time.process_time() - cpu)
    seconds /= max(case.rows / 3000, 1)
    verdict, causes = said["verdict"], said.get("causes", [])
    found = tuple(c["id"] for c in causes)
    others = tuple(a for c in causes for a in c.get("alternatives", []))
    true = {name for name, _ in case.truth}
    confident = verdict == "named"
    exact = confident and set(found) == true and bool(true)
    wrong = confident and any(
        c["id"] not in true and not true & set(c.get("alternatives", [])) for c in causes
    )
    marked = Mark(
        kind=case.kind, label=_label(case), severity=case.severity, decidable=case.decidable,
        seed=case.seed, said=case.said, standing=case.standing, verdict=verdict, found=found,
        alternatives=others, first=verdict in ("named", "ambiguous") and found[:1] != () and found[0] in true,
        exact=exact, wrong=wrong, right=_right(case, verdict, exact, {*found, *others}),
        seconds=seconds, sizes=_sizes(case, causes) if confident else (), fault=fault,
        near=case.absorbed > NEAR,
    )  # fmt: skip
    if not exact:
        return marked
    both = _shares(case, said.get("gain") or {})
    gain, best = both or (None, None)
    levels = tuple(
        LevelGain(one["channel"], *shares)
        for one in said.get("gain_at_levels", [])
        if (shares := _shares(case, one)) is not None
    )
    again = None if (off := said.get("again")) is None else (np.mean(off <= 1), np.mean(off <= 2))
    return replace(marked, gain=gain, oracle=best, levels=levels, again=again)


def _right(case: Case, verdict: str, exact: bool, mentioned: set[str]) -> bool:
    if case.kind == "clean":
        return verdict == "consistent"
    if case.kind == "foreign":
        return verdict == "unknown"
    if case.kind == "undecidable":
        return verdict == "ambiguous" and case.expected <= mentioned <= case.tolerated
    return exact


def _sizes(case: Case, causes: list[dict]) -> tuple[Size, ...]:
    true, sizes = dict(case.truth), []
    for c in causes:
        if c["id"] in true and c["id"] not in case.unsized and c.get("magnitude") is not None:
            off = abs(c["magnitude"] - true[c["id"]])
            std = c.get("magnitude_std") or np.nan
            sizes.append(Size(c["id"], float(off / abs(true[c["id"]])), float(off / std)))
    return tuple(sizes)


def _shares(case: Case, gain: dict) -> tuple[float, float] | None:
    """The diagnosis's share and the oracle's over the same rows and the true noise.

    So a generous floor gains nothing. None where there is nothing above the noise to gain.
    """
    if "rmse_before" not in gain:
        return None
    held = held_out_rows(gain, case.rows, case.file_cycles)
    best = None if held is None else oracle(list(case.units), case.rig, held)
    if best is None or best.before**2 < 1.5 * best.floor**2:
        return None
    above = best.before**2 - best.floor**2
    # against one error before: the two zeros may be taken over other rows
    share = (best.before**2 - gain["rmse_after"] ** 2) / above
    return float(share), best.share


def _label(case: Case) -> str:
    if case.kind == "foreign":
        return case.foreign
    return case.severity if case.kind == "undecidable" else case.label
