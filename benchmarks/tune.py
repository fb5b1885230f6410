"""Look for each peer's fastest setting at each accuracy, as a user who knows the answer would."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from cases import ACCURACIES_PCT, QUARTER_DEG, Case
from programs import Peer, Setting

EDGES = (1.2, 0.8, 0.6, 0.4, 0.3, 0.2, 0.15, 0.1, 0.08, 0.06)
WEDGE_GRIDS = ((2.0, 0.6), (3.0, 0.4), (3.0, 0.6), (4.0, 0.8), (5.0, 0.9))
FULL_GRIDS = ((4.0, 0.6), (4.0, 0.8))
QUARTER_GRIDS = ((2.0, 0.6), (3.0, 0.6), (4.0, 0.8))
CANDIDATES, NEAR_ENOUGH = 2, 1.05
"""On the second cup, which differs by its holes alone, the so many fastest settings of the first are
tried at each accuracy, with those that missed it by less than this factor."""
TWO_BELOW_S = 30.0
"""Single runs are noisy: where it costs little, the second fastest is timed five times too."""
SLOW_S = 150.0
"""A setting slower than this ends its series: the next is finer and slower still."""


def tuned(
    peer: Peer,
    case: Case,
    reference: float,
    steps: Path,
    elsewhere: list[dict[str, Any]] | None = None,
) -> list[dict[str, Any]]:
    """Every run tried; `elsewhere`: those tried on another cup, to start from."""
    tried: list[dict[str, Any]] = []
    for series in searched(peer) if elsewhere is None else [candidates(elsewhere)]:
        for setting in series:
            run = peer.run(case, setting, steps) | {"setting": asdict(setting)}
            if case.figure in run:
                run["error_pct"] = 100 * (run[case.figure] / reference - 1)
            tried.append(run)
            print(f"{case.name} {peer.name} {setting}: {brief(run)}", flush=True)
            reached = abs(run.get("error_pct", 100)) < min(ACCURACIES_PCT)
            over = run["wall_s"] > SLOW_S or "memory" in run.get("failed", "")
            if elsewhere is None and (reached or over):
                break
    return tried


def searched(peer: Peer) -> list[list[Setting]]:
    """Series of settings, each from coarse to fine."""
    full, ccx, quarter = peer.sector == 360, "CalculiX" in peer.name, peer.sector == QUARTER_DEG
    # on the whole cup the first grid was better at every accuracy: NGSolve's runs show it
    grids = FULL_GRIDS[:1] if ccx else FULL_GRIDS if full else WEDGE_GRIDS
    grids = QUARTER_GRIDS if quarter else grids
    return [
        [Setting(order, maxh, edge, grading) for edge in EDGES[:: 2 if ccx or quarter else 1]]
        for maxh, grading in grids
        for order in ((2,) if ccx else (2, 3))
    ]


def candidates(tried: list[dict[str, Any]]) -> list[Setting]:
    found: list[Setting] = []
    for accuracy in ACCURACIES_PCT:
        good = [r for r in tried if abs(r.get("error_pct", 100)) < NEAR_ENOUGH * accuracy]
        best = sorted(good, key=lambda r: r["wall_s"])[:CANDIDATES]
        found += [Setting(**r["setting"]) for r in best]
    return list(dict.fromkeys(found))


def settings(tried: list[dict[str, Any]]) -> dict[str, Any]:
    """The two fastest settings at each accuracy."""
    return {f"{a:g}": fastest(tried, a) for a in ACCURACIES_PCT}


def fastest(tried: list[dict[str, Any]], accuracy_pct: float) -> list[dict[str, Any]]:
    good = [r for r in tried if abs(r.get("error_pct", 100)) < accuracy_pct]
    best = sorted(good, key=lambda r: r["wall_s"])[:2]
    return [r["setting"] for r in best if r is best[0] or r["wall_s"] < TWO_BELOW_S]


def brief(run: dict[str, Any]) -> str:
    if "failed" in run:
        return f"{run['wall_s']} s, {run['failed'][:80]}"
    return f"{run['wall_s']} s, {run['error_pct']:+.3f} %, {run['unknowns']} unknowns"
