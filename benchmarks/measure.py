"""Whole processes timed from outside: wall clock, peak memory, and the JSON on their last line."""

from __future__ import annotations

import json
import os
import resource
import statistics
import subprocess
import time
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

MEMORY_LIMIT = 16 * 2**30
"""Address space of a run [bytes]: one that needs more fails instead of taking the machine down."""
TIME_LIMIT_S = 600.0


def cpu() -> str:
    """The processor's name (Linux)."""
    with open("/proc/cpuinfo", encoding="utf-8") as info:
        return next((line.split(":")[1].strip() for line in info if "model name" in line), "")


def run(
    command: Sequence[str],
    folder: Path,
    extra: Mapping[str, str] | None = None,
    memory: int = MEMORY_LIMIT,
) -> dict[str, Any]:
    """Start a command in `folder` and wait; start-up is part of what is timed.

    Returns its JSON with "wall_s", "cpu_s" (user and system, its children too) and "peak_MB" added, or
    "failed" with the reason.
    """
    with open(folder / "out.txt", "w+b") as out, open(folder / "err.txt", "w+b") as err:
        began = time.perf_counter()
        child = subprocess.Popen(
            list(command), cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err,
            env=os.environ | dict(extra or {}), preexec_fn=partial(_limit, memory), start_new_session=True,
        )  # fmt: skip
        status, usage = _wait(child, began + TIME_LIMIT_S)
        wall = time.perf_counter() - began
        out.seek(0)
        err.seek(0)
        said, complaint = out.read().decode(errors="replace"), err.read().decode(errors="replace")
    found = {
        "wall_s": round(wall, 3), "cpu_s": round(usage.ru_utime + usage.ru_stime, 3),
        "peak_MB": round(usage.ru_maxrss / 1024),
    }  # fmt: skip
    if status is None:
        return found | {"failed": f"stopped after {TIME_LIMIT_S:.0f} s"}
    if status != 0:
        last = complaint.strip().splitlines()[-1:] or [f"status {status}"]
        return found | {"failed": last[0][:200]}
    return found | _last_json(said)


def _limit(memory: int) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


def _wait(child: subprocess.Popen, until: float) -> tuple[int | None, Any]:
    """Exit status and resources of the child with those it waited for; None if it was stopped."""
    while True:
        pid, status, usage = os.wait4(child.pid, os.WNOHANG)
        if pid:
            child.returncode = os.waitstatus_to_exitcode(status)
            return child.returncode, usage
        if time.perf_counter() > until:
            os.killpg(child.pid, 9)
            _, _, usage = os.wait4(child.pid, 0)
            child.returncode = -9
            return None, usage
        time.sleep(0.002)


def _last_json(text: str) -> dict[str, Any]:
    """The JSON object that ends the output: on one line, or spread over several."""
    for start in (text.rfind("\n{"), text.find("{")):
        try:
            return dict(json.loads(text[max(start, 0) :]))
        except ValueError:
            continue
    raise ValueError(f"no JSON in the output: {text[-200:]!r}")


def repeated(runs: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Median and range of the wall times of equal runs, with the other figures of the median run."""
    good = sorted((r for r in runs if "failed" not in r), key=lambda r: r["wall_s"])
    if len(good) < len(runs) or not good:
        return dict(next((r for r in runs if "failed" in r), {"failed": "not run"}))
    walls = [r["wall_s"] for r in good]
    return dict(good[len(good) // 2]) | {
        "wall_s": statistics.median(walls),
        "wall_range_s": [walls[0], walls[-1]],
        "cpu_s": statistics.median(r.get("cpu_s", 0.0) for r in good),
        "runs": len(good),
        "peak_MB": max(r["peak_MB"] for r in good),
    }
