"""How fast a study runs, and what a second worker brings: `python benchmarks/study.py [designs]`.

Designs are full ones: K_b with bounds, lobes, wave-generator stress, K_e, backlash. The clock starts when
the workers have answered once, so that their start (some seconds, once per study) is told apart.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
import tomllib
from dataclasses import replace
from pathlib import Path

from flexspline.pipeline.study.cluster import worker_pool
from flexspline.pipeline.study.drive import evaluate_all
from flexspline.pipeline.study.evaluate import evaluate
from flexspline.pipeline.study.load import study_from
from flexspline.pipeline.study.run import source_of, trial_store_of

EXAMPLES = Path(__file__).parents[1] / "examples"
STUDY = """
design = "xb1-40.toml"
[vary]
"flexspline.wall_thickness_mm" = { min = 0.30, max = 0.54 }
"flexspline.length_mm" = { min = 20.0, max = 40.0 }
"flexspline.diaphragm_thickness_mm" = { min = 0.4, max = 0.9 }
"flexspline.boss_diameter_mm" = { min = 16.5, max = 22.0 }
"flexspline.inner_fillet_mm" = { min = 0.5, max = 1.5 }
[run]
method = "sobol"
"""


def seconds_per_design(workers: int, designs: int) -> tuple[float, float, float]:
    """Of the study, of its start; and how many workers were at work on average."""
    study = study_from(tomllib.loads(STUDY), EXAMPLES, "benchmark")
    run = study.file.run.model_copy(update={"evaluations": designs})
    study = replace(study, file=study.file.model_copy(update={"run": run}))
    source = source_of(study)
    with tempfile.TemporaryDirectory() as folder:
        began = time.perf_counter()
        with worker_pool(workers, "") as pool:
            store = trial_store_of(study, Path(folder))
            first = source.task({"flexspline.wall_thickness_mm": 0.4})
            for future in [pool.submit(evaluate, first) for _ in range(2 * workers)]:
                future.result()
            ready = time.perf_counter()
            rows = evaluate_all(source, store, pool, evaluate, lambda progress: None)
            done = time.perf_counter()
    failed = sum(bool(r.outcome.reason) for r in rows)
    print(f"{workers} workers: {failed} of {len(rows)} designs without figures")
    busy = sum(r.outcome.seconds for r in rows) / (done - ready)
    return (done - ready) / designs, ready - began, busy


def main() -> None:
    designs = int(sys.argv[1]) if len(sys.argv) > 1 else 60
    print(f"load average before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    found = {w: seconds_per_design(w, designs) for w in (1, 2)}
    for workers, (each, start, busy) in found.items():
        print(
            f"{workers} workers: {each:.3f} s per design, start {start:.1f} s, {busy:.2f} at work"
        )
    print(f"two against one: {found[1][0] / found[2][0]:.2f} times")
    print(f"1000 designs on two workers: {1000 * found[2][0] + found[2][1]:.0f} s")
    print(f"load average after: {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
