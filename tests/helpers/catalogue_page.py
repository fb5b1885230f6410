"""The text of docs/catalogue.md. To write it again:

python3 tests/helpers/catalogue_page.py
"""

from __future__ import annotations

from pathlib import Path

from catalogue.compare import CatalogueFinding, compare
from example_files import EXAMPLES

from flexspline.geometry.rated import LOST_MOTION_SHARE, LOST_MOTION_TORQUE

ROOT = Path(__file__).parents[2]
DATA = EXAMPLES / "catalogue"
PAGE = ROOT / "docs" / "catalogue.md"


def page(finding: CatalogueFinding) -> str:
    gain = finding.gain
    refuted = [r for r in finding.rows if r.refuted]
    limited = [r for r in finding.rows if r.limit_arcmin is not None]
    above = (gain.rmse_calibrated**2 - gain.rmse_after**2) / (
        gain.rmse_calibrated**2 - gain.noise_floor**2
    )
    shapes = "\n".join(
        f"| {s.ratio_class} | {s.K2_over_K1:.2f} | {s.K3_over_K1:.2f} | {s.T2_over_T1:.2f} | "
        f"{1e4 * s.T1_per_size3:.2f} |"
        for s in finding.shapes
    )
    rows = "\n".join(
        f"| {r.row.size} | {r.row.ratio_class} | {r.straight_K:.0f} | {r.low_torque_pct:+.0f} | "
        f"{r.line_pct:.1f} | {r.soft_pct:.1f} | {r.floor_pct:.1f} | {r.booked_arcmin:.1f} | "
        f"{'–' if r.limit_arcmin is None else f'{r.limit_arcmin:g}'} |"
        for r in finding.rows
    )
    lost = "\n".join(
        f"| {m.size} | {m.rated_Nm:g} | {m.K1:g} | {m.windup_arcmin:.2f} |"
        for m in finding.lost_motion
    )
    ratios = [r.row.K[2] / r.row.K[0] for r in finding.rows]
    soft = min(ratios), max(ratios)
    worst = max(finding.rows, key=lambda r: r.soft_pct)
    least, most = (f(m.windup_arcmin for m in finding.lost_motion) for f in (min, max))
    low, high = (f(r.low_torque_pct for r in finding.rows) for f in (min, max))
    return f"""\
# What a straight line gets wrong about a catalogue's K1, K2, K3

Written by `python3 tests/helpers/catalogue_page.py`; a test compares it with what
the program finds. Data and sources: `examples/catalogue/SOURCES.md`. Catalogue figures are nominal
averages, not one gear's measurement.

A simulation with one stiffness draws a straight line. The catalogues draw three slopes: K1 up to T1, K2
up to T2, K3 beyond; K3/K1 is {soft[0]:.1f} to {soft[1]:.1f}. Each of {len(finding.rows)} rows is \
compared up to 2·T2 with the straight line through 0
that fits that very row best. Below T1 that line is {low:.0f} to {high:.0f} % too stiff.

## The extension, and its gain on sizes left out

Soft wind-up with one shape for each ratio class, and T1 in proportion to size³:

| ratio | K2/K1 | K3/K1 | T2/T1 | T1/size³ [1e-4 N·m] |
|---|---|---|---|---|
{shapes}

Held out: each of {gain.held_out.each} sizes in turn, all its ratio classes at once. Of the size left out
only its straight stiffness is used, as a simulation has no more. Rms error of twist, over all
rows: straight line {gain.rmse_calibrated:.1f} %, soft wind-up {gain.rmse_after:.1f} %, rounding of the \
printed K {gain.noise_floor:.1f} %; {100 * above:.0f} % of the
squared error above the rounding is gone. The worst is size {worst.row.size} at ratio \
{worst.row.ratio_class}, {worst.soft_pct:.1f} %: small sizes deviate
most from the size³ line.

| size | ratio | straight K [N·m/rad] | too stiff below T1 [%] | line [%] | soft [%] | rounding [%] | \
counted as gap [′] | lost motion allowed [′] |
|---|---|---|---|---|---|---|---|---|
{rows}

## A straight line counts wind-up as clearance

A line with the stiffness K3, drawn through the curve above T2, does not pass through 0: its two branches
leave a gap, which the four-term sum would call clearance. For {len(refuted)} of the {len(limited)} rows \
with a stated limit that gap
alone is larger than all the lost motion that the maker allows. Clearance would show at any torque, at
± {LOST_MOTION_TORQUE} too; so it is not clearance.

## Lost motion is mostly elastic

Twist between ± {LOST_MOTION_TORQUE}, 2·{LOST_MOTION_SHARE:g}·T_N/K1: {100 * least:.0f} to \
{100 * most:.0f} % of the limit of 1′
for the sizes whose rated torque is in the data.

| size | T_N [N·m] | K1 [N·m/rad] | elastic [′] |
|---|---|---|---|
{lost}
"""


if __name__ == "__main__":
    PAGE.write_text(page(compare(DATA)), encoding="utf-8")
