"""Look for each peer's fastest setting at each accuracy, as a user who knows the answer would."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from cases import ACCURACIES_PCT, Case
from programs import Peer, Setting

EDGES = (1.2, 0.8, 0.6, 0.4, 0.3, 0.2, 0.15, 0.1, 0.08, 0.06)
WEDGE_GRIDS = ((2.0, 0.6), (3.0, 0.4), (3.0, 0.6), (4.0, 0.8), (5.0, 0.9))
FULL_GRIDS = ((4.0, 0.6), (4.0, 0.8))
TWO_BELOW_S = 30.0
"""Single runs are noisy: where it costs little, the second fastest is timed five times too."""
SLOW_S = 150.0
"""A setting slower than this ends its series: the next is finer and slower still."""


def tuned(
    peer: Peer, case: Case, reference: float, steps: Path
) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Every run tried, and the two fastest settings at each accuracy."""
    orders = (2,) if "CalculiX" in peer.name else (2, 3)
    tried: list[dict[str, Any]] = []
    for maxh, grading in WEDGE_GRIDS if peer.sector < 360 else FULL_GRIDS:
        for order in orders:
            for edge in EDGES:
                setting = Setting(order, maxh, edge, grading)
                run = peer.run(case, setting, steps) | {"setting": asdict(setting)}
                if "K" in run:
                    run["error_pct"] = 100 * (run["K"] / reference - 1)
                tried.append(run)
                print(f"{case.name} {peer.name} {setting}: {brief(run)}", flush=True)
                reached = abs(run.get("error_pct", 100)) < min(ACCURACIES_PCT)
                if reached or run["wall_s"] > SLOW_S or "memory" in run.get("failed", ""):
                    break
    return tried, {f"{a:g}": fastest(tried, a) for a in ACCURACIES_PCT}


def fastest(tried: list[dict[str, Any]], accuracy_pct: float) -> list[dict[str, Any]]:
    good = [r for r in tried if abs(r.get("error_pct", 100)) < accuracy_pct]
    best = sorted(good, key=lambda r: r["wall_s"])[:2]
    return [r["setting"] for r in best if r is best[0] or r["wall_s"] < TWO_BELOW_S]


def brief(run: dict[str, Any]) -> str:
    if "failed" in run:
        return f"{run['wall_s']} s, {run['failed'][:80]}"
    return f"{run['wall_s']} s, {run['error_pct']:+.3f} %, {run['unknowns']} unknowns"
