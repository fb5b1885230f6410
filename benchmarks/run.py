"""Every benchmark in one run, side by side; writes results.json here and docs/benchmarks.md.

    pip install ngsolve; apt-get install calculix-ccx
    python benchmarks/run.py [--peers-python PYTHON] [--quick]

`--peers-python` names an interpreter that has NGSolve, if this one has not. `--quick` reuses the
peers' settings and the references of the last results.json.
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

from cases import ACCURACIES_PCT, CASES, ROOT
from measure import repeated
from page import page
from programs import Setting, ours, peers, stiffness_command
from references import references
from scaling import growth
from tune import tuned

RUNS = 5
RESULTS = Path(__file__).with_name("results.json")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--peers-python", default=sys.executable)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    old = json.loads(RESULTS.read_text(encoding="utf-8")) if options.quick else {}
    everybody = peers(options.peers_python)
    result: dict[str, Any] = {"machine": machine(options.peers_python)}
    with tempfile.TemporaryDirectory() as name:
        steps = Path(name)
        result["references"] = old.get("references") or references(everybody[0], steps)
        save(result)
        result["tuning"], settings = old.get("tuning", {}), old.get("settings", {})
        for case in CASES:
            for peer in everybody:
                key = f"{case.name}, {peer.name}"
                if key not in settings:
                    K = result["references"][case.name]["K"]
                    result["tuning"][key], settings[key] = tuned(peer, case, K, steps)
                    save(result)
        result["settings"] = settings
        result["load_at_timing"] = os.getloadavg()
        result["times"] = timed(everybody, settings, result["references"], steps)
        save(result)
    result["scaling"] = old.get("scaling") or growth()
    save(result)
    (ROOT / "docs" / "benchmarks.md").write_text(page(result), encoding="utf-8")


def timed(everybody, settings, known, steps: Path) -> list[dict[str, Any]]:
    """Five rounds; within a round everybody runs once, so that a slow minute hits all alike."""
    jobs: dict[tuple, Any] = {}
    for case in CASES:
        for accuracy in ACCURACIES_PCT:
            jobs[case.name, accuracy, "flexspline", ""] = lambda c=case, a=accuracy: ours(c, a)
            for peer in everybody:
                for words in settings[f"{case.name}, {peer.name}"][f"{accuracy:g}"]:
                    s = Setting(**words)
                    jobs[case.name, accuracy, peer.name, str(s)] = lambda p=peer, c=case, s=s: (
                        p.run(c, s, steps)
                    )
        jobs[case.name, 0.5, "flexspline stiffness", ""] = lambda c=case: stiffness_command(c, 0.5)
    rounds: dict[tuple, list[dict[str, Any]]] = {key: [] for key in jobs}
    for number in range(RUNS):
        for key, job in jobs.items():
            rounds[key].append(job())
            print(number + 1, *key, rounds[key][-1], flush=True)
    found = []
    for (case, accuracy, program, setting), runs in rounds.items():
        figures = repeated(runs)
        if "K" in figures:
            figures["error_pct"] = 100 * (figures["K"] / known[case]["K"] - 1)
            errors = [abs(100 * (r["K"] / known[case]["K"] - 1)) for r in runs]
            figures["worst_error_pct"] = max(errors)
        found.append(
            {"case": case, "accuracy_pct": accuracy, "program": program, "setting": setting}
            | figures
        )
    return found


def machine(peers_python: str) -> dict[str, Any]:
    with open("/proc/cpuinfo", encoding="utf-8") as info:
        cpu = next((line.split(":")[1].strip() for line in info if "model name" in line), "")
    code = "import ngsolve; print(ngsolve.__version__)"
    ngsolve = subprocess.run([peers_python, "-c", code], capture_output=True, text=True, check=True)
    ccx = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False)
    return {
        "cpu": cpu, "cores": os.cpu_count(), "memory_GB": round(memory_GB(), 1),
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
