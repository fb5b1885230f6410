"""Every kind of structure, shortage and plan has words, in the channels in which it is found."""

from __future__ import annotations

from typing import get_args

import pytest
from histories import sweep

from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.outcome import Doing, DoingKind
from flexspline.pipeline.diagnosis.prediction import Prediction
from flexspline.pipeline.diagnosis.shortage import LeapingAngle, Leaps
from flexspline.pipeline.diagnosis.structure import FormKind, UnnamedForm
from flexspline.pipeline.diagnosis.sweep.nuisance.nuisance_terms import nuisance_terms
from flexspline.pipeline.diagnosis.timeless import ROW, TIME, over_rows
from flexspline.results.diagnosis.advice import DOING, doing_words
from flexspline.results.diagnosis.shortage_words import shortage_words
from flexspline.results.diagnosis.structure_words import ANYWHERE, FORMS, words_of

RIG = FitContext(Prediction(10.0, 0.2, 60.0, 5.0), sweep(units=2))


def test_every_kind_of_form_has_words() -> None:
    told = {kind for kind, _ in FORMS} | {*ANYWHERE, "one_specimen"}
    assert told == set(get_args(FormKind))


def test_what_is_said_in_time_is_said_along_the_rows_too() -> None:
    timed = {kind for kind, channel in FORMS if channel == TIME}
    assert timed == {kind for kind, channel in FORMS if channel == ROW}
    assert not any("time" in words for (_, channel), words in FORMS.items() if channel == ROW)


def test_every_nuisance_term_has_words() -> None:
    said = {
        words_of((term.form,), over_rows(term.channel) if rows else term.channel)
        for term in nuisance_terms(RIG)
        for rows in (False, True)
    }
    assert {
        "a separate gap of unit 2",
        "a step in time of unit 1",
        "a wave along the record",
    } <= said


def test_several_forms_are_said_in_one_order() -> None:
    one, other = UnnamedForm("own_gap"), UnnamedForm("own_zero")
    both = "a separate gap in each cycle; a separate zero offset in each cycle"
    assert words_of((one, other), "cycle") == words_of((other, one), "cycle") == both


def test_a_trend_over_a_dimension_names_its_key() -> None:
    key = "flexspline.length_mm"
    assert words_of((UnnamedForm("trend"),), key) == f"a trend over {key}"


@pytest.mark.parametrize("kind", get_args(DoingKind))
def test_every_plan_has_words(kind: DoingKind) -> None:
    assert set(DOING) == set(get_args(DoingKind))
    assert "{" not in doing_words(Doing(kind, (1.0, 2.0)))


def test_a_large_move_is_no_power_of_ten() -> None:
    leaping = LeapingAngle(Leaps(5, (1286.0, 3381.0), (-8.0, 18.0), 120.0), 1321.0)
    said = shortage_words(leaping)
    assert "at −8 to 18 N·m" in said
    assert "by 120 arcsec from row to row" in said
