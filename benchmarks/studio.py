"""How long the live page takes from a slider's move to figures that have changed, in a real browser.

    pip install '.[studio,test]'; apt-get install chromium
    python benchmarks/studio.py [--moves 8] [--write]

A move is one step of a slider and its `input` event, as a hand makes it. The clock runs in the page, from
the event to the first frame after the last of the figures came. `--write` puts the table into docs/studio.md.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from measure import cpu

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "helpers"))

from browser import chromium  # noqa: E402
from studio_page import Page, running  # noqa: E402

if TYPE_CHECKING:
    from playwright.sync_api import Browser

DESIGNS = ("xb1-40", "hat-25")
SLIDERS = {
    "flexspline's shape": (
        "flexspline.wall_thickness_mm", "flexspline.ring_thickness_mm", "flexspline.length_mm",
        "flexspline.diaphragm_thickness_mm", "flexspline.inner_fillet_mm",
    ),
    "all else": (
        "shaft.segment[1].outer_diameter_mm", "material.flexspline.youngs_modulus_GPa",
        "gear.module_mm", "bearing.radial_clearance_um", "load.torque_Nm",
    ),
}  # fmt: skip
FIGURES = (
    "K_b_Nm_per_rad", "K_e_Nm_per_rad", "K_series_Nm_per_rad", "K_b_lobes_Nm_per_rad",
    "wave_generator_peak_mises_MPa", "backlash_arcsec.total",
)  # fmt: skip
MEASURES = {
    "first": "K_b, K_e, backlash",
    "all": "K_b at the lobes and wave-generator stress too",
    "exact": "and both to the command line's tolerance",
}
HARD = next(iter(SLIDERS))
Times = dict[str, dict[str, list[float]]]
"""Milliseconds by group of sliders and by what was waited for."""
DEMAND_MS = 150
BUSY = "The load is other work on the machine: a quiet one answers sooner. To be measured again."
MARKS = "<!-- measured: benchmarks/studio.py --write -->", "<!-- end of measured -->"

MOVE = """async ([key, figures]) => {
  const row = (figure) => document.querySelector(`#answers tr[data-key="${figure}"]`);
  const here = (figure) => row(figure) && !row(figure).closest(".stale");
  const rough = () => document.querySelector("#answers td.rough");
  const slider = document.querySelector(`.row[data-key="${key}"] input[type=range]`);
  const steps = { first: () => ["K_b_Nm_per_rad", "K_e_Nm_per_rad", "backlash_arcsec.total"].every(here),
    all: () => figures.every(here), exact: () => figures.every(here) && !rough() };
  const found = {}, began = performance.now();
  slider.stepUp();
  slider.dispatchEvent(new Event("input", { bubbles: true }));
  return new Promise((done) => {
    const look = () => {
      for (const [name, met] of Object.entries(steps))
        if (!(name in found) && met()) found[name] = performance.now() - began;
      if ("exact" in found) done(found);
      else requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
}"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--moves", type=int, default=8, help="of each slider")
    parser.add_argument("--write", action="store_true", help="into docs/studio.md")
    options = parser.parse_args()
    with browser() as used:
        found = {name: measured(used, name, options.moves) for name in DESIGNS}
        text = page(found, used.version)
    print(text)
    if options.write:
        path = ROOT / "docs" / "studio.md"
        before, _, rest = path.read_text(encoding="utf-8").partition(MARKS[0])
        after = rest.partition(MARKS[1])[2]
        path.write_text(f"{before}{MARKS[0]}\n{text}\n{MARKS[1]}{after}", encoding="utf-8")


@contextmanager
def browser() -> Iterator[Browser]:
    """The tests' Chromium; without one, a line says why."""
    try:
        with chromium() as used:
            yield used
    except BaseException as fault:
        if type(fault).__name__ != "Skipped":
            raise
        sys.exit(str(fault))


def measured(used: Browser, name: str, moves: int) -> Times:
    """Every move's times; between moves everything comes to rest."""
    times: Times = {group: {kind: [] for kind in MEASURES} for group in SLIDERS}
    with running(ROOT / "examples" / f"{name}.toml") as server:
        tab = Page(used, server.url)
        for move in range(moves + 1):
            for group, key in ((g, k) for g, keys in SLIDERS.items() for k in keys):
                tab.complete()
                tab.tab.wait_for_timeout(200)
                took: dict[str, Any] = tab.tab.evaluate(MOVE, [key, list(FIGURES)])
                for kind, value in took.items():
                    if move:  # the first round loads and warms what a session loads once
                        times[group][kind].append(value)
        tab.close()
    return times


def page(found: dict[str, Times], version: str) -> str:
    """The table and where it was measured."""
    lines = [
        f"| design | sliders | moves | {' | '.join(MEASURES.values())} |",
        "|---|---|---|" + "---|" * len(MEASURES),
    ]
    for name, groups in found.items():
        for group, times in groups.items():
            cells = " | ".join(map(median_and_p90, times.values()))
            lines.append(f"| {name} | {group} | {len(times['all'])} | {cells} |")
    whole = statistics.median(ms for g in found.values() for t in g.values() for ms in t["all"])
    hardest = max(statistics.median(groups[HARD]["all"]) for groups in found.values())
    met = "met" if hardest <= DEMAND_MS else "not met"
    load = os.getloadavg()[0]
    return "\n".join([
        "Milliseconds from the move to the figures, median (90 of 100 within):", "", *lines, "",
        f"Demanded: {DEMAND_MS} ms at the median, lobes, stress, backlash included: {met}, hardest:",
        f"{hardest:.0f} ms; over all moves {whole:.0f} ms. {cpu()}, {os.cpu_count()} cores,",
        f"load average {load:.1f};",
        f"headless Chromium {version}, which draws on the same cores for want of a graphics card.",
        *([BUSY] if load > (os.cpu_count() or 1) else []),
    ])  # fmt: skip


def median_and_p90(times: list[float]) -> str:
    return f"{statistics.median(times):.0f} ({statistics.quantiles(times, n=10)[-1]:.0f})"


if __name__ == "__main__":
    main()
