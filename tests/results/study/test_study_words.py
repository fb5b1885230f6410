"""What a study's report says when models disagree, and when no design is allowed."""

import tomllib
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome
from flexspline.pipeline.study.indices import Indices
from flexspline.pipeline.study.load import study_from
from flexspline.pipeline.study.result import StudyResult
from flexspline.pipeline.study.scatter import TIGHTENING_FACTORS, Attribution, Scatter, Tightened
from flexspline.pipeline.study.tolerance import ScatteredInput
from flexspline.pipeline.study.verified import Check, Verified
from flexspline.results.report.document import Pictures, Table
from flexspline.results.report.payload import payload_of
from flexspline.results.report.pdf import pdf_of
from flexspline.results.study.gains import gains_drawn, gains_shown
from flexspline.results.study.labels import beyond, entry, valued
from flexspline.results.study.notes import border_warnings, notes, unmoved, unsettled, wide_bounds
from flexspline.results.study.question import question
from flexspline.results.study.record import summary, words
from flexspline.results.study.report import study_document
from flexspline.results.study.scatter_section import scatter_section
from flexspline.results.study.sensitivity import lines
from flexspline.results.study.unbeaten import unbeaten_start
from flexspline.results.study.why import (
    disagreement,
    influences,
    limits,
    misses,
    unfollowed,
)

WALL = "flexspline.wall_thickness_mm"
FLAG = "wave_generator_peak_at_excluded_border"
K, STRESS, TOTAL = "K_b_Nm_per_rad", "wave_generator_peak_mises_MPa", "backlash_arcsec.total"
HALF_SEAT = "wave_generator_peak_half_seat_mises_MPa"
STUDY = f"""
design = "xb1-40.toml"
[vary]
"{WALL}" = {{ min = 0.3, max = 0.5 }}
[objective]
"{K}" = "maximize"
[constraint]
"{STRESS}" = {{ max = 300.0 }}
"{TOTAL}" = {{ max = 90.0 }}
[run]
method = "sobol"
"""
NO_OBJECTIVE = STUDY.replace(f'[objective]\n"{K}" = "maximize"\n', "")


def tolerance_of(gains: dict[str, tuple[float, ...]]) -> Scatter:
    """95 % ranges narrower by so many arcsec [at 0.75, 0.5, 0.25 and none of each input's tolerance]."""
    own = tuple(ScatteredInput(key, 1.0, 0.1, 0.9, 1.1, False) for key in gains)
    tight = tuple(
        Tightened(key, factor, 80.0 - gain, gain)
        for key, each in gains.items()
        for factor, gain in zip(TIGHTENING_FACTORS, each, strict=True)
    )
    one = np.array([0.5] * len(gains))
    ends = np.stack([one, one], 1)
    shares = Attribution(Indices(one, ends, one, ends))
    values = np.linspace(60.0, 140.0, 16)
    return Scatter(TOTAL, own, values, values, 60.0, 140.0, shares, tight)


def test_gains_of_tighter_tolerances_do_not_fall_in_print() -> None:
    sampled = {
        "material.flexspline.youngs_modulus_GPa": (0.25, 0.19, 0.06, 0.03),
        WALL: (10.3, 19.6, 19.5, 28.0),
    }
    scatter = tolerance_of(sampled)
    table = next(b for b in scatter_section(scatter) if isinstance(b, Table))
    assert [list(row[-4:]) for row in table.rows] == [
        ["< 0.3"] * 4,  # one falls by 0.22
        ["10.3", "19.6", "19.6", "28.0"],  # 19.55 twice
    ]
    (said,) = [str(b) for b in scatter_section(scatter) if "last four columns" in str(b)]
    assert "Gains below 0.3 arcsec are sampling error." in said
    assert set(gains_drawn(scatter)) == set(gains_shown(scatter))
    assert [gains_drawn(scatter)[k] for k in gains_drawn(scatter)][:4] == [0.0] * 4


def test_gains_that_rise_as_they_should_are_printed_as_sampled() -> None:
    table = next(
        b
        for b in scatter_section(tolerance_of({WALL: (0.0, 0.1, 0.2, 0.3)}))
        if isinstance(b, Table)
    )
    assert list(table.rows[0][-4:]) == ["0.0", "0.1", "0.2", "0.3"]


def result_of(text: str = STUDY, more: Mapping[str, float] | None = None) -> StudyResult:
    """Ten designs, stress 310 + 10 i MPa: none is allowed, the first is nearest."""
    study = study_from(tomllib.loads(text), EXAMPLES, "test")
    rows = tuple(
        Row(
            i,
            {WALL: 0.3 + 0.02 * i},
            Outcome({K: 3e4 + i, STRESS: 310.0 + 10 * i, TOTAL: 85.0 + i, **(more or {})}),
        )
        for i in range(10)
    )  # fmt: skip
    return StudyResult(study, rows)


def test_bounds_that_bolt_holes_leave_wide_are_said() -> None:
    """Half of them ± 0.3 %, within the 0.5 % asked; the others up to ± 4 %."""
    result = result_of()
    wide = [0.003] * 5 + [0.01, 0.02, 0.03, 0.035, 0.04]
    bounds = ("K_b_bounds_Nm_per_rad[0]", "K_b_bounds_Nm_per_rad[1]")
    rows = [
        replace(
            r,
            outcome=Outcome(r.outcome.figures | dict(zip(bounds, (3e4 - a, 3e4 + a), strict=True))),
        )
        for r, a in zip(result.rows, (3e4 * half for half in wide), strict=True)
    ]
    (line,) = wide_bounds(replace(result, rows=tuple(rows)))
    assert line.startswith(
        "in 5 of 10 designs bolt holes leave bounds of K_b wider than ± 0.5 %, up to ± 4 %"
    )
    assert not list(wide_bounds(result))


def test_where_nothing_is_allowed_each_constraint_says_how_far() -> None:
    stress, total, nearest = misses(result_of())
    assert nearest == "Design 0: wall thickness 0.3\u202fmm."
    assert "0 of 10 designs meet at most 300" in stress
    assert "design 0, has 310" in stress
    assert "6 of 10 designs meet at most 90.0" in total  # 85, 86, …, 90


def test_where_something_is_allowed_nothing_is_missed() -> None:
    assert misses(result_of(STUDY.replace("300.0", "310.0"))) == []


@pytest.mark.parametrize(
    ("K_start", "stress", "said"),
    [(3.2e4, 300.0, True), (2.9e4, 300.0, False), (3.2e4, 311.0, False)],
)
def test_a_start_that_nothing_beats_is_said(K_start: float, stress: float, said: bool) -> None:
    """The stiffest allowed design has 30 000 N·m/rad; a start above 310 MPa is not allowed."""
    result = result_of(STUDY.replace("300.0", "310.0"))
    began = replace(result, start=Outcome({K: K_start, STRESS: stress, TOTAL: 85.0}))
    text = str(payload_of(study_document(began, ())))
    assert ("No design is better than the start design" in text) is said
    assert bool(unbeaten_start(began)) is said


@pytest.mark.parametrize(("stress", "broken"), [(300.0, False), (311.0, True)])
def test_a_start_that_is_not_allowed_is_marked(stress: float, broken: bool) -> None:
    result = result_of(STUDY.replace("300.0", "310.0"))
    began = replace(result, start=Outcome({K: 3.2e4, STRESS: stress, TOTAL: 85.0}))
    line = next(
        t for t in words(began, summary(began) | {"files": []}).split("\n") if "start:" in t
    )
    report = str(payload_of(study_document(began, ())))
    assert ("breaks a constraint" in line and "311" in line) is broken
    assert ("breaks a constraint" in report) is broken
    assert ("start (not allowed)" in report) is broken


def test_a_figure_just_beyond_a_limit_has_the_digits_that_show_it() -> None:
    assert beyond(STRESS, {STRESS: 300.09}, (None, 300.0)) == "300.1 MPa"
    assert beyond(STRESS, {STRESS: 300.004}, (None, 300.0)) == "300.004 MPa"
    assert beyond(STRESS, {STRESS: 311.0}, (None, 300.0)) == valued(STRESS, {STRESS: 311.0})


def test_a_constraint_that_holds_is_said_with_its_limit() -> None:
    (line,) = (
        t for t in limits(result_of(STUDY.replace("300.0", "310.0"))) if "is limited by" in t
    )
    assert "310" in line.partition("allowed:")[0]
    assert "at most 310" in line


def test_a_wider_span_is_named_where_the_objective_still_gains() -> None:
    """All designs allowed; stiffness rises with the wall, and the best lies at the span's upper end."""
    text = (
        STUDY.replace("300.0", "900.0").replace("90.0", "900.0").replace("max = 0.5", "max = 0.48")
    )
    (said,) = limits(result_of(text))
    assert "upper end of the range of wall thickness" in said


@pytest.mark.parametrize("columns", ["", "60"])
def test_the_best_are_listed_with_their_constrained_figures(
    columns: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At the end of the line, or where that is too long below it."""
    monkeypatch.setenv("COLUMNS", columns)
    result = result_of(STUDY.replace("300.0", "330.0"))
    listed = words(result, summary(result) | {"files": []}).splitlines()[1:]
    between = "\n    " if columns else ", "
    figures = result.best(1)[0].outcome.figures
    stress, total = valued(STRESS, figures), valued(TOTAL, figures)
    assert "\n".join(listed).startswith(
        f"  design 2: wall thickness {entry(WALL).with_unit(0.34)}: K_b = {valued(K, figures)}{between}"
        f"σ_WG = {stress}, Δ_bl = {total}"
    )


def test_the_start_is_listed_with_them_and_what_it_breaks() -> None:
    result = result_of(STUDY.replace("300.0", "330.0"))
    start = Outcome({K: 4e4, STRESS: 436.0, TOTAL: 80.0})
    result = replace(result, start=start)
    line = words(result, summary(result) | {"files": []}).splitlines()[1]
    figures = f"{valued(K, start.figures)}, σ_WG = {valued(STRESS, start.figures)}, Δ_bl = "
    assert figures in line
    assert line.index(figures) < line.index("; breaks a constraint (")


def test_a_bound_is_listed_by_its_name() -> None:
    low = "K_b_bounds_Nm_per_rad[0]"
    text = STUDY.replace("300.0", "330.0").replace(
        "[constraint]", f'[constraint]\n"{low}" = {{ min = 1 }}'
    )
    result = result_of(text, {low: 2.9e4})
    said = words(result, summary(result) | {"files": []})
    assert f"{entry(low).name} = {valued(low, {low: 2.9e4})}" in said


def test_the_report_repeats_what_is_asked() -> None:
    text = STUDY.replace("min = 0.3, max = 0.5", "min = 0.3, max = 0.5, steps = 3").replace(
        "[objective]", '[link]\n"flexspline.ring_thickness_mm" = { of = "flexspline.wall_thickness_mm", '
        "plus = 0.15 }\n[objective]",
    )  # fmt: skip
    (table,) = (b for b in question(result_of(text).study) if isinstance(b, Table))
    assert [tuple(cell.replace("\u202f", " ") for cell in row) for row in table.rows] == [
        ("varied", "wall thickness", "0.3 to 0.5 mm, 3 values"),
        ("linked", "ring thickness", "wall thickness + 0.15 mm"),
        ("objective", entry(K).name, "as large as possible"),
        ("constraint", entry(STRESS).name, "at most 300 MPa"),
        ("constraint", entry(TOTAL).name, "at most 90.0 arcsec"),
    ]


def test_of_a_front_every_design_at_an_end_is_named() -> None:
    """Stiffness rises with the wall and so does mass: both ends of the front's span are named."""
    text = (
        STUDY.replace("300.0", "900.0")
        .replace("90.0", "900.0")
        .replace('"maximize"', f'"maximize"\n"{STRESS}" = "minimize"')
    )
    result = result_of(text.replace("max = 0.5", "max = 0.48"))
    said = [line for line in limits(result) if "end of the range of wall thickness" in line]
    assert [line.split(" lies")[0] for line in said] == ["Design 9", "Design 0"]


def test_a_neighbour_in_the_grid_that_could_not_be_built_is_said() -> None:
    """The stiffest wall allowed, 0.4 mm, is no constraint's: the next, 0.6 mm, gave no design."""
    text = STUDY.replace("min = 0.3, max = 0.5", "values = [0.3, 0.4, 0.6]").replace(
        "sobol", "grid"
    )
    result = result_of(text.replace("300.0", "340.0"))
    first, second = (
        Row(i, {WALL: w}, r.outcome)
        for i, (w, r) in enumerate(zip((0.3, 0.4), result.rows, strict=False))
    )
    third = Row(2, {WALL: 0.6}, Outcome(faults=("too thick",)))
    assert limits(replace(result, rows=(first, second, third))) == [
        "Next to design 1, the next wall thickness of the grid, 0.6\u202fmm, could not be built or solved."
    ]


def test_without_an_objective_the_usual_figures_are_followed() -> None:
    said = influences(result_of(NO_OBJECTIVE))
    assert [s.split(",")[0] for s in said] == [
        "Flexspline stiffness", "Peak von Mises stress", "Backlash",
    ]  # fmt: skip
    assert all("rises with wall thickness (rank correlation +1.00)" in s for s in said)


@pytest.mark.parametrize(
    ("check", "said"),
    [
        (Check(K, 100.0, (99.0, 101.0), 90.0, (89.0, 91.0)), "by more than their bounds"),
        (Check(STRESS, 500.0, None, 600.0, None), "by more than 5 %"),
    ],
)
def test_an_alarm_says_what_may_be_behind_it(check: Check, said: str) -> None:
    assert not check.agrees
    assert said in disagreement(check)
    result = replace(result_of(), verified=(Verified(0, (check,)),))
    document = study_document(result, ())
    assert said in str(payload_of(document))
    assert pdf_of(document, {}).startswith(b"%PDF")


def test_the_report_says_how_holes_entered() -> None:
    """The example has holes in both parts."""
    result = result_of()
    rows = tuple(
        replace(r, outcome=Outcome({**r.outcome.figures, "K_e_holes_factor": 0.97}))
        for r in result.rows
    )
    with_factor = " ".join(notes(replace(result, rows=rows)))
    assert "change K_e by −3.0 %" in with_factor
    assert "shaft without its holes" not in with_factor
    assert "shaft without its holes" not in " ".join(notes(result))  # K_e was in no row
    failed = " ".join(notes(replace(result, no_holes_effect="the keyway has no mesh")))
    assert "shaft without its holes or keyway" in failed
    assert "failed (the keyway has no mesh)" in failed
    assert "K_b of every design with bolt holes lies between" in with_factor


def test_a_constraint_on_a_peak_at_the_excluded_border_is_said() -> None:
    result = result_of()
    assert not list(border_warnings(result))
    rows = tuple(
        replace(r, outcome=Outcome({**r.outcome.figures, FLAG: float(r.slot < 3)}))
        for r in result.rows
    )
    (line,) = border_warnings(replace(result, rows=rows))
    assert line.startswith(
        f"{entry(STRESS).name} (a constraint of this study): in 3 of 10 designs at excluded"
    )
    assert "(a constraint of this study): in 3 of 10" in " ".join(notes(replace(result, rows=rows)))
    unasked = STUDY.replace(f'"{STRESS}" = {{ max = 300.0 }}\n', "")
    assert not list(border_warnings(replace(result_of(unasked), rows=rows)))


@pytest.mark.parametrize(
    ("most", "flagged_designs", "said"),
    [
        ("330.0", 10, "3 designs meet this constraint, 3 of them with such a value"),
        ("330.0", 1, "3 designs meet this constraint, 1 of them with such a value"),
        ("300.0", 10, ""),
    ],
)
def test_a_constraint_that_marked_peaks_keep_names_the_figure_to_use(
    most: str, flagged_designs: int, said: str
) -> None:
    result = result_of(STUDY.replace("300.0", most))
    rows = tuple(
        replace(r, outcome=Outcome({**r.outcome.figures, FLAG: float(r.slot < flagged_designs)}))
        for r in result.rows
    )
    result = replace(result, rows=rows)
    (line,) = border_warnings(result)
    assert ("designs meet this constraint" in line) is bool(said)
    assert said in line
    assert f"use {HALF_SEAT} instead" in line
    assert f"use {HALF_SEAT} instead" in " ".join(notes(result))


def test_a_study_that_asks_for_the_half_seat_figure_is_not_told_to() -> None:
    text = STUDY.replace("[constraint]", f'[constraint]\n"{HALF_SEAT}" = {{ max = 500.0 }}')
    result = flagged(result_of(text, {HALF_SEAT: 310.0}))
    (line,) = border_warnings(result)
    assert "the figure to use" not in line


def test_keys_of_holes_are_named_as_not_followed() -> None:
    key = "shaft.bolt_hole_diameter_mm"
    text = STUDY.replace("[objective]", f'"{key}" = {{ values = [2.5, 3.0] }}\n[objective]')
    assert unfollowed(result_of(text).study) == key
    assert f"The fast model ignores {key}" in " ".join(notes(result_of(text)))


@pytest.mark.parametrize(
    ("density", "said"),
    [
        ("", "7850 kg/m³ (of steel, because the file states none)"),
        ("4430.0", "4430 kg/m³ (as stated)"),
    ],
)
def test_the_report_says_which_density_the_mass_is_of(density: str, said: str) -> None:
    result = result_of()
    steel = result.study.design.material.flexspline
    if density:
        steel = steel.model_copy(update={"density_kg_per_m3": float(density)})
    design = result.study.design.model_copy(
        update={"material": result.study.design.material.model_copy(update={"flexspline": steel})}
    )
    assert f"Mass at {said}." in notes(replace(result, study=replace(result.study, design=design)))


def test_a_peak_at_the_excluded_border_is_marked_in_study_table_and_notes() -> None:
    result = result_of(STUDY.replace("300.0", "450.0"))
    marked = tuple(
        replace(r, outcome=replace(r.outcome, figures={**r.outcome.figures, FLAG: float(i < 4)}))
        for i, r in enumerate(result.rows)
    )
    said = replace(result, rows=marked)
    assert valued(STRESS, marked[0].outcome.figures).endswith("MPa (at excluded border)")
    assert valued(STRESS, marked[4].outcome.figures).endswith("MPa")
    (line,) = [n for n in notes(said) if "at excluded border" in n]
    assert "in 4 of 10 designs" in line
    assert not any("at excluded border" in n for n in notes(result))  # of a study begun before
    assert "†" in str(payload_of(study_document(said, ())))


def flagged(result: StudyResult) -> StudyResult:
    """Every peak at the excluded border."""
    rows = tuple(
        replace(r, outcome=replace(r.outcome, figures={**r.outcome.figures, FLAG: 1.0}))
        for r in result.rows
    )
    return replace(result, rows=rows)


@pytest.mark.parametrize(
    ("text", "marks"),
    [
        (STUDY.replace("300.0", "450.0"), True),
        (STUDY.replace(f'"{STRESS}" = {{ max = 300.0 }}\n', ""), False),  # the stress is no line
        (STUDY, False),  # nothing is allowed: no table
        (NO_OBJECTIVE, False),  # ten designs without a best: no table
    ],
)
def test_a_dagger_is_explained_where_one_stands_in_a_table(text: str, marks: bool) -> None:
    result = flagged(result_of(text))
    (line,) = [n for n in notes(result) if "at excluded border" in n]
    assert ("†" in line) is marks
    tables = [b for b in study_document(result, ()).blocks if isinstance(b, Table)]
    assert ("†" in str(tables)) is marks


def test_few_designs_without_an_objective_have_their_figures_in_the_report() -> None:
    """One of ten could be built, and breaks a constraint of the study."""
    result = result_of(NO_OBJECTIVE)
    failed = Outcome(faults=("too thick",))
    rows = (result.rows[0], *(replace(r, outcome=failed) for r in result.rows[1:]))
    document = study_document(flagged(replace(result, rows=rows)), ())
    asked, table, *_ = (b for b in document.blocks if isinstance(b, Table))
    assert [row[0] for row in asked.rows] == ["varied", "constraint", "constraint"]
    assert [c.head for c in table.columns] == ["", "design 0 (not allowed)"]
    assert [row[1] for row in table.rows] == ["0.3", "30\u202f000", "310 †", "85.0"]
    assert "The built designs" in str(payload_of(document))


@pytest.mark.parametrize(("most", "allowed"), [("300.0", False), ("450.0", True)])
def test_there_is_no_best_so_far_where_nothing_is_allowed(most: str, allowed: bool) -> None:
    document = study_document(result_of(STUDY.replace("300.0", most)), ["convergence.png"])
    (shown,) = (b for b in document.blocks if isinstance(b, Pictures))
    caption = str(shown.figures[0].caption)
    assert ("best so far" in caption) is allowed
    assert ("none meets every constraint" in caption) is not allowed


def test_with_drawn_teeth_the_ring_of_the_sensitivities_is_said_not_to_be_the_files() -> None:
    plain = load_design(EXAMPLES / "xb1-40.toml")
    drawn = plain.changed({"flexspline.teeth": "drawn"})
    (said,) = (line for line in lines(drawn, ()) if "ring_thickness_mm" in line)
    assert "not the file's 0.55 mm" in said
    assert not any("ring_thickness_mm" in line for line in lines(plain, ()))


@pytest.mark.parametrize(
    ("values", "said"),
    [
        (
            [*range(100, 115), 114, 113, 114, 112, 114],
            None,
        ),  # the best is found before the last five
        ([*range(100, 120)], "still improved by 4.2 % in the last quarter of the 20 designs"),
        ([*range(100, 115), 114.4, 114, 114, 114, 114], None),  # by less than bounds are wide
    ],
)
def test_a_search_that_has_not_settled_says_so(values: list[float], said: str | None) -> None:
    """K is to be large: the first 15 of 20 designs have at most 114 kN·m/rad."""
    text = STUDY.replace('"sobol"', '"optimize"').replace("300.0", "900.0").replace("90.0", "900.0")
    study = study_from(tomllib.loads(text), EXAMPLES, "test")
    rows = tuple(
        Row(i, {WALL: 0.3 + 0.01 * i}, Outcome({K: 1e3 * v, STRESS: 310.0, TOTAL: 85.0}))
        for i, v in enumerate(values)
    )
    lines = list(unsettled(StudyResult(study, rows)))
    if said is None:
        assert not lines
    else:
        (line,) = lines
        assert said in line
        assert "the best “Flexspline stiffness" in line
        assert K not in line
    sampled = study_from(tomllib.loads(text.replace('"optimize"', '"sobol"')), EXAMPLES, "test")
    assert not list(unsettled(StudyResult(sampled, rows)))


@pytest.mark.parametrize(
    ("values", "said"), [((100.0, 100.0, 100.0), 1), ((100.0, 100.0, 100.1), 0)]
)
def test_an_objective_that_nothing_varied_moves_is_said(
    values: tuple[float, ...], said: int
) -> None:
    study = study_from(tomllib.loads(STUDY), EXAMPLES, "test")
    rows = tuple(
        Row(i, {WALL: 0.3 + 0.01 * i}, Outcome({K: 1e3 * v, STRESS: 310.0 + i, TOTAL: 85.0}))
        for i, v in enumerate(values)
    )
    lines = list(unmoved(StudyResult(study, rows)))
    assert len(lines) == said
    assert all("is the same in all 3 designs" in line for line in lines)
