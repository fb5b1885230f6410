"""How long `flexspline stiffness` takes on random designs.

    python benchmarks/stiffness_at_random.py [first [count [at once]]]

The designs of the reliability tests (`tests/helpers/random_designs.py`), those that load, from number
`first` on, so many `at once` (one without it), each with an empty cache. A line of JSON each, then how
many kept within the demands.
"""

from __future__ import annotations

import json
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import count, islice
from pathlib import Path
from typing import Any

from cases import ROOT
from measure import run

from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import design_from

sys.path.insert(0, str(ROOT / "tests" / "helpers"))
from random_designs import design_of, toml  # type: ignore[import-not-found]

FIRST, COUNT, AT_ONCE = 800_000, 100, 1
"""Beyond the numbers that the tests use."""
USUAL_S, LONGEST_S, MOST_MB = 15.0, 90.0, 2048
"""What is demanded of 95 in 100, and of all."""


def designs(first: int) -> Iterator[tuple[int, str, Design]]:
    """Number, file and design."""
    for number in count(first):
        text = toml(design_of(number, slips=False))
        try:
            yield number, text, design_from(tomllib.loads(text))
        except DesignError:
            continue


def timed(number: int, text: str, design: Design) -> dict[str, Any]:
    """Seconds, memory, K with bounds and warnings of one design, and what kind it is."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "design.toml").write_text(text, encoding="utf-8")
        command = [
            sys.executable,
            "-m",
            "flexspline.results.entry",
            "stiffness",
            "design.toml",
            "--json",
        ]
        found = run(command, folder, {"FLEXSPLINE_CACHE": str(folder / "cache")})
    f, s = design.flexspline, design.shaft
    kept = ("wall_s", "cpu_s", "peak_MB", "failed", "warnings")
    return {
        "number": number, "kind": f.kind, "holes": [f.bolt_count, s.bolt_count],
        "keyway": s.keyway is not None, "tolerance_pct": design.solver.tolerance_pct,
        **{key: value for key, value in found.items() if key in kept or key.startswith("K_")},
    }  # fmt: skip


def main() -> None:
    given = [int(word) for word in sys.argv[1:]]
    first, number, at_once = [*given, *(FIRST, COUNT, AT_ONCE)[len(given) :]]
    rows = []
    with ThreadPoolExecutor(at_once) as pool:
        for row in pool.map(lambda drawn: timed(*drawn), islice(designs(first), number)):
            rows.append(row)
            print(json.dumps(row), flush=True)
    usual = sum(r["wall_s"] <= USUAL_S for r in rows)
    late = sum(r["wall_s"] > LONGEST_S for r in rows)
    large = sum(r["peak_MB"] > MOST_MB for r in rows)
    failed = sum("failed" in r for r in rows)
    print(
        f"{usual} of {len(rows)} within {USUAL_S:g} s, {late} above {LONGEST_S:g} s, "
        f"{large} above {MOST_MB} MB, {failed} failed"
    )


if __name__ == "__main__":
    main()
