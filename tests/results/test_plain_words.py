"""Sentences of reports say it as an engineer would."""

from pathlib import Path

import pytest
from hand_made_gear import content
from page_text import strings
from pypdf import PdfReader
from written_report import payload

from flexspline.fea.toothed_ring.equivalent import EquivalentRing

RING = EquivalentRing(0.55, 0.71, 0.66, 0.69, 0.01, 1000)


def said_of_a_run():
    pictures = {"wave_generator": Path("none.png")}
    return " ".join(strings(payload(content(ring=RING, pictures=pictures))))


@pytest.mark.parametrize(
    ("old", "plain"),
    [
        ("no value there means anything", "singular at sharp edges, so no value is reported there"),
        ("No number there converges", "Values there do not converge with mesh refinement"),
        ("growing all round", "Equivalent thickness in hoop stiffness:"),
    ],
)
def test_a_run(old, plain):
    said = said_of_a_run()
    assert old not in said
    assert plain in said


def test_a_diagnosis(finished_sweep):
    printed = PdfReader(finished_sweep.folder / "diagnosis.pdf").pages
    pages = " ".join(p.extract_text() for p in printed)
    said = " ".join((finished_sweep.stdout + pages).split())
    for old in (
        "Found, and named", "worth to know", "name no cause", "friction stays, lag goes",
        "the program knows", "How sure",
    ):  # fmt: skip
        assert old not in said, old
    for plain in (
        "Causes identified (named)", "Prediction error on data not used in the fit",
        "(backlash crossing) were not used for identification", "No other known cause",
        "hysteresis from friction does not change, lag does",
    ):  # fmt: skip
        assert plain in said, plain
