"""The wave generator's seat: how wide it is, what moves on it, and what docs/theory.md says of it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.fea.axisymmetric.revolved_field import RevolvedField
from flexspline.fea.axisymmetric.stress import ellipse_stress
from flexspline.fea.types import Elastic
from flexspline.geometry.design import Design
from flexspline.geometry.keys import with_values
from flexspline.geometry.load import load_design
from flexspline.geometry.meridian import with_narrow_seat
from flexspline.pipeline.ellipse_peak import NARROW_SEAT, SEAT_TOLERANCE

PAGE = Path(__file__).parents[2] / "docs" / "theory.md"
RING = "flexspline.ring_width_mm"


def on_a_seat(design: Design, share: float) -> RevolvedField:
    outline = design.part("flexspline").meridian
    if share < 1:
        outline = with_narrow_seat(outline, share)
    material = Elastic.of(design.material.flexspline)
    w0, apart = design.gear.centre_distance_mm, design.part("flexspline").exclusion_mm
    return ellipse_stress(outline, material, w0, apart, SEAT_TOLERANCE)


@pytest.mark.parametrize("example", ["xb1-40", "hat-25"])
def test_a_narrow_seat_leaves_the_body_as_it_was(example: str) -> None:
    whole = load_design(EXAMPLES / f"{example}.toml").part("flexspline").meridian
    half = with_narrow_seat(whole, 0.5)
    assert half.volume == pytest.approx(whole.volume, rel=1e-12)
    assert half.patch_area("seat") == pytest.approx(whole.patch_area("seat") / 2, rel=1e-12)
    assert half.sharp_corners == whole.sharp_corners


def test_the_ring_follows_the_ellipse_on_the_narrow_seat_alone(record) -> None:
    """XB1-40: the ring from 22 to 30 mm, so a seat half as wide from 24 to 28 mm."""
    found = on_a_seat(load_design(EXAMPLES / "xb1-40.toml"), 0.5)
    r, z = found.places.T
    inside = r < 19.2 + 1e-9
    seat = inside & (z > 24 - 1e-9) & (z < 28 + 1e-9)
    moved = found.displacement[seat, 0]
    record(
        "xb1-40, seat half as wide: what the seat moves", "w0, prescribed", 0.2, moved.mean(), "mm"
    )
    assert moved == pytest.approx(0.2)
    beside = inside & (((z > 22) & (z < 23.9)) | (z > 28.1))
    assert (np.abs(found.displacement[beside, 0] - 0.2) > 1e-6).mean() > 0.9


@pytest.mark.parametrize("example", ["xb1-40", "hat-25"])
def test_the_page_says_what_a_seat_half_as_wide_does(example: str) -> None:
    """Both within the tolerance to which the peaks settle, and the rounding of the page."""
    (row,) = re.findall(rf"(?m)^\| `{example}`, ring.*$", PAGE.read_text(encoding="utf-8"))
    _, _, whole, half, change, _ = (cell.strip() for cell in row.split("|"))
    design = load_design(EXAMPLES / f"{example}.toml")
    peaks = [on_a_seat(design, share).peak for share in (1.0, NARROW_SEAT)]
    said = [float(cell.split()[0]) for cell in (whole, half)]
    assert [p.mises_MPa for p in peaks] == pytest.approx(said, rel=SEAT_TOLERANCE)
    assert not peaks[1].at_excluded_border
    assert 100 * (said[1] / said[0] - 1) == pytest.approx(
        float(change.replace("−", "-").split()[0]), abs=0.5
    )


def test_the_page_says_what_the_rings_width_does() -> None:
    text = " ".join(PAGE.read_text(encoding="utf-8").split())
    (found,) = re.findall(r"(\d+), (\d+) and (\d+) MPa on `xb1-40` with 13, 8 and 2 mm", text)
    design = load_design(EXAMPLES / "xb1-40.toml")
    peaks = [
        on_a_seat(with_values(design, {RING: w}), 1.0).peak.mises_MPa for w in (13.0, 8.0, 2.0)
    ]
    assert peaks == pytest.approx([float(f) for f in found], rel=SEAT_TOLERANCE)
