"""Hides effects, asks for diagnoses, prints the table:  python tests/hidden/run.py --records 300."""

from __future__ import annotations

import argparse
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")  # one record, one core
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).parents[1]))

from hidden.adapter import diagnose
from hidden.case import KINDS
from hidden.cases import NoCaseError, draw_case
from hidden.mark import Mark, mark
from hidden.score import breakdown, failures, figures, table


def one(number: int, seed: int, kind: str | None, cause: str | None) -> Mark | None:
    try:
        return mark(draw_case(seed, number, kind, cause), diagnose)
    except NoCaseError as fault:
        print(f"{seed}:{number} {fault}", file=sys.stderr)
        return None


def marks(seed: int, numbers: range, kind: str | None, cause: str | None, jobs: int) -> list[Mark]:
    """Marks of the cases with these numbers, in order."""
    task = partial(one, seed=seed, kind=kind, cause=cause)
    if jobs == 1:
        found = [task(k) for k in numbers]
    else:
        with ProcessPoolExecutor(jobs) as pool:
            found = list(pool.map(task, numbers, chunksize=4))
    return [m for m in found if m is not None]


def main() -> None:
    ask = argparse.ArgumentParser(description=__doc__)
    ask.add_argument("--seed", type=int, default=1)
    ask.add_argument("--records", type=int, default=100)
    ask.add_argument("--first", type=int, default=0, help="number of the first record")
    ask.add_argument("--kind", choices=KINDS)
    ask.add_argument("--cause", help="cause, foreign kind or the name of a design that cannot tell")
    ask.add_argument("--jobs", type=int, default=1)
    ask.add_argument(
        "--save", type=Path, help="write the first record's csv and toml here, and stop"
    )
    asked = ask.parse_args()
    if asked.save:
        case = draw_case(asked.seed, asked.first, asked.kind, asked.cause)
        asked.save.mkdir(parents=True, exist_ok=True)
        (asked.save / "measured.csv").write_text(case.csv, encoding="utf-8")
        (asked.save / "design.toml").write_text(case.design, encoding="utf-8")
        print(f"{case.kind} {case.truth}\n{case.said}\n--Kb {case.K_b} --Ke {case.K_e}")
        return
    numbers = range(asked.first, asked.first + asked.records)
    found = marks(asked.seed, numbers, asked.kind, asked.cause, asked.jobs)
    print(table(figures(found)))
    print()
    print(breakdown(found))
    print()
    narrowed = "".join(f" --{k} {v!r}" for k in ("kind", "cause") if (v := getattr(asked, k)))
    print(f"Seed s:n again: python tests/hidden/run.py --seed s --first n --records 1{narrowed}")
    print(failures(found))


if __name__ == "__main__":
    main()
