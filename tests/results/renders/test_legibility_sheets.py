"""The sheets around the rendered parts can be read: titles, bars, labels of any length."""

from dataclasses import replace

import numpy as np
import pytest
from legibility import drawn_figures, faults

from flexspline.fea.types import StressPeak
from flexspline.results.renders.picture_elements import stress_note
from flexspline.results.renders.scene import Shot, View
from flexspline.results.renders.sheet import INSET, LARGE_INSET, MAIN, Bar, Mark, Sheet, write_sheet


def shot(size):
    width, height = size
    white = np.full((height, width, 3), 255, np.uint8)
    return Shot(white, View(-60.0, 30.0), np.zeros(3), 0.1)


def bar(high, text, beyond=True):
    return Bar("von Mises\nin MPa", high, text, beyond)


def mark(text, at=(0.0, 0.0, 0.0), shown_by="main"):
    return Mark(np.array(at), text, shown_by)


TITLE = "Flexspline on the wave generator: stress"
ELLIPSE = "von Mises; seat moved radially by w₀ cos 2φ, w₀ = 0.2 mm"
PEAK = StressPeak(436.0, (19.6, 0.0, 21.4), "near edges", 0.4, False, 436.0)
BORDER = replace(PEAK, at_excluded_border=True, mises_at_twice_MPa=343.0)
SHEETS = {
    "border": Sheet(
        TITLE, ELLIPSE, "along the axis",
        "Displacements drawn 1000 times as large. Red: edges before deformation.\n"
        + stress_note(BORDER, True),
        bar(436.0, "436"),
        mark("peak, at border\nof excluded zone\n436 MPa\n(hidden)", shown_by="none"),
    ),
    "cup": Sheet(
        TITLE, ELLIPSE, "along the axis", stress_note(PEAK, True), bar(436.0, "436"),
        mark("peak\n436 MPa"),
    ),
    "huge": Sheet(
        "Output shaft: stress under load torque",
        "von Mises stress, torque 1.235e+06 N·m; cut open, not deformed", "from below",
        stress_note(PEAK, False), bar(1.235e9, "1 235 000 000"), mark("peak\n1 235 000 000 MPa"),
    ),
    "tiny": Sheet(
        "Flexspline: stress under load torque",
        "von Mises stress, torque 1e-09 N·m; cut open, not deformed", "from below",
        stress_note(PEAK, True), bar(3.21e-7, "0.000000321", False), mark("peak\n0.000000321 MPa"),
    ),
    "hidden": Sheet(
        TITLE, ELLIPSE, "along the axis",
        "Displacements drawn 1000 times as large. Red: edges before deformation.\n" + stress_note(PEAK, True),
        bar(99.9, "99.9"), mark("peak, hidden here\n99.9 MPa", shown_by="none"),
    ),
    "inset": Sheet(
        TITLE, ELLIPSE, "along the axis", "", bar(7.5, "7.50"),
        mark("peak\n7.50 MPa", (10.0, 4.0, -8.0), "inset"),
    ),
    "mesh": Sheet(
        "Output shaft: mesh", "1 234 567 quadratic tetrahedra in a sector of 360° (the whole part)",
        "from below",
        legend=(("#123f66", "mount: held"), ("#dd8f2d", "mesh: takes the torque"),
                ("#2f7ab8", "seat: wave generator")),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SHEETS)
def test_sheet(tmp_path, name):
    inset = shot(LARGE_INSET if name == "mesh" else INSET)
    with drawn_figures() as found:
        write_sheet(tmp_path / "s.png", shot(MAIN), inset, SHEETS[name])
    (figure,) = found
    assert faults(figure) == []
