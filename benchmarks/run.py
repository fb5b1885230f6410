"""Every benchmark in one run, side by side; writes results.json here and docs/benchmarks.md.

    pip install ngsolve; apt-get install calculix-ccx
    python benchmarks/run.py [--peers-python PYTHON] [--resume] [--rounds 5]

`--peers-python` names an interpreter that has NGSolve, if this one has not. `--resume` keeps what the
last results.json holds of references, of the search for the peers' settings, and of the growth, and looks for
what is not in it.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from importlib.metadata import version
from pathlib import Path
from typing import Any

from cases import ACCURACIES_PCT, CASES, LOADS, ROOT, Case
from measure import cpu, repeated
from page import page
from programs import Setting, ours, peers, stiffness_command
from references import references
from scaling import growth
from tune import settings, tuned

RUNS = 5
LONG_S = 8.0
"""A peer's setting that took longer in the search is not run again: its scatter does not matter here."""
RESULTS = Path(__file__).with_name("results.json")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--peers-python", default=sys.executable)
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--rounds", type=int, default=RUNS)
    options = parser.parse_args()
    old = json.loads(RESULTS.read_text(encoding="utf-8")) if options.resume else {}
    python = options.peers_python
    kept = {k: old[k] for k in ("references", "tuning", "scaling", "load_at_scaling") if k in old}
    result: dict[str, Any] = {"machine": machine(python), "references": {}, "tuning": {}} | kept
    with tempfile.TemporaryDirectory() as name:
        steps = Path(name)
        for load in LOADS:
            if Case(0, load).name not in result["references"]:
                result["references"] |= references(load, python, steps)
                save(result)
        search(python, result, steps)
        result["rounds"], result["load_at_timing"] = options.rounds, os.getloadavg()
        result["times"] = timed(python, result, steps, options.rounds)
        save(result)
    if "scaling" not in result:
        result["load_at_scaling"] = [round(x, 2) for x in os.getloadavg()]
        result["scaling"] = growth()
        save(result)
    (ROOT / "docs" / "benchmarks.md").write_text(page(result), encoding="utf-8")


def search(python: str, result: dict[str, Any], steps: Path) -> None:
    """Peers' settings on the first cup from scratch, on the second from the first's.

    Of a peak on both from scratch: on another mesh its error has another sign as well as another size.
    """
    for case in CASES:
        for peer in peers(python, case):
            key = f"{case.name}, {peer.name}"
            if key in result["tuning"]:
                continue
            reference = result["references"][case.name][case.figure]
            first = f"{Case(0, case.load).name}, {peer.name}" if case.figure == "K" else key
            known = result["tuning"].get(first)
            result["tuning"][key] = tuned(peer, case, reference, steps, known)
            save(result)


def timed(python: str, result: dict[str, Any], steps: Path, count: int) -> list[dict[str, Any]]:
    """Rounds; within a round everybody runs once, so that a slow minute hits all alike."""
    known = result["references"]
    searched = {
        (key, str(Setting(**r["setting"]))): r
        for key, tried in result["tuning"].items()
        for r in tried
    }
    long: dict[tuple, dict[str, Any]] = {}
    jobs: dict[tuple, Any] = {}
    for case in CASES:
        for accuracy in ACCURACIES_PCT:
            jobs[case.name, accuracy, "flexspline", ""] = lambda c=case, a=accuracy: ours(c, a)
            for peer in peers(python, case):
                key = f"{case.name}, {peer.name}"
                for words in settings(result["tuning"][key])[f"{accuracy:g}"]:
                    s = Setting(**words)
                    before = searched[key, str(s)]
                    if before["wall_s"] > LONG_S:
                        long[case.name, accuracy, peer.name, str(s)] = before
                    jobs[case.name, accuracy, peer.name, str(s)] = lambda p=peer, c=case, s=s: (
                        p.run(c, s, steps)
                    )
        if case.load == "uniform":
            jobs[case.name, 0.5, "flexspline stiffness", ""] = lambda c=case: stiffness_command(
                c, 0.5
            )
    rounds: dict[tuple, list[dict[str, Any]]] = {key: [] for key in jobs}
    for number in range(count):
        for key, job in jobs.items():
            if key in long:
                rounds[key] = [long[key]]
                continue
            rounds[key].append(job())
            print(number + 1, *key, rounds[key][-1], flush=True)
    found, figure_of = [], {c.name: c.figure for c in CASES}
    for (case, accuracy, program, setting), runs in rounds.items():
        figures = repeated(runs)
        figures.pop("setting", None)  # a run of the search carries it as a table
        of = figure_of[case]
        if of in figures:
            figures["error_pct"] = 100 * (figures[of] / known[case][of] - 1)
            errors = [abs(100 * (r[of] / known[case][of] - 1)) for r in runs]
            figures["worst_error_pct"] = max(errors)
        found.append(
            {"case": case, "accuracy_pct": accuracy, "program": program, "setting": setting}
            | figures
        )
    return found


def machine(peers_python: str) -> dict[str, Any]:
    code = "import ngsolve; print(ngsolve.__version__)"
    ngsolve = subprocess.run([peers_python, "-c", code], capture_output=True, text=True, check=True)
    ccx = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False)
    return {
        "cpu": cpu(), "cores": os.cpu_count(), "memory_GB": round(memory_GB(), 1),
        "system": platform.platform(), "python": platform.python_version(),
        "flexspline": version("flexspline"), "NGSolve": ngsolve.stdout.split()[-1],
        "CalculiX": ccx.stdout.split()[-1], "numpy": version("numpy"), "scipy": version("scipy"),
        "pytetwild": version("pytetwild"), "pypardiso": version("pypardiso"),
        "commit": subprocess.run(
            ["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True,
            check=False,
        ).stdout.strip(),
    }  # fmt: skip


def memory_GB() -> float:
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30


def save(result: dict[str, Any]) -> None:
    RESULTS.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
