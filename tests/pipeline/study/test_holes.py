"""K_e corrected for holes by the nominal design's solid solve, and when verify still rings; K_b enclosed."""

from pathlib import Path

import pytest
from example_files import EXAMPLES
from study_bench import study_of, threads

from flexspline.fea.deadline import OutOfTimeError
from flexspline.geometry.design import Solver
from flexspline.geometry.errors import GeometryError
from flexspline.geometry.keys import with_values, without_holes
from flexspline.geometry.load import load_design
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.part_stiffness import part_stiffness
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.study.claims import Row
from flexspline.pipeline.study.evaluate import Outcome, Task, fast_K_e, figures_of
from flexspline.pipeline.study.holes import (
    HolesEffect,
    UnknownEffect,
    cut_compliance,
    drifts,
    holes_of,
    unfollowed,
)
from flexspline.pipeline.study.run import nominal_holes, run_study, source_of, trial_store_of
from flexspline.pipeline.study.verify import checked, solid_answer

Figures = tuple[dict[str, float], dict[str, float], dict[str, float]]
DESIGN = load_design(EXAMPLES / "xb1-40.toml")
LESS = 0.97
"""K_e with holes over K_e without that `HOLES` gives in the example."""
HOLES = HolesEffect(
    (1 / LESS - 1) / (fast_K_e(DESIGN).K_Nm_per_rad * cut_compliance(DESIGN)), 0.02, 0.0
)


KNOWN_K_b = 31_322.0
"""N·m/rad, of xb1-40: the finest independent solution."""


def test_the_figures_follow_from_the_corrected_K() -> None:
    design = load_design(EXAMPLES / "xb1-40.toml")
    plain, corrected = (dict(figures_of(design, ("torsion",), h).figures) for h in (None, HOLES))
    assert corrected["K_e_Nm_per_rad"] == pytest.approx(0.97 * plain["K_e_Nm_per_rad"])
    low, high = (corrected[f"K_e_bounds_Nm_per_rad[{i}]"] for i in (0, 1))
    assert low == pytest.approx(0.95 * plain["K_e_bounds_Nm_per_rad[0]"])
    assert high == pytest.approx(0.99 * plain["K_e_bounds_Nm_per_rad[1]"])
    assert corrected["K_e_holes_factor"] == pytest.approx(LESS)
    assert corrected["K_b_Nm_per_rad"] == plain["K_b_Nm_per_rad"]
    both = 1 / corrected["K_e_Nm_per_rad"] + 1 / corrected["K_b_Nm_per_rad"]
    assert 1 / corrected["K_series_Nm_per_rad"] == pytest.approx(both)
    shaft, before = (f["backlash_arcsec.shaft"] for f in (corrected, plain))
    assert shaft == pytest.approx(before / 0.97)


def test_a_part_without_holes_has_no_factor_and_is_not_solved() -> None:
    lines: list[str] = []
    plain = without_holes(load_design(EXAMPLES / "xb1-40.toml"))
    assert holes_of(plain, fast_K_e, lines.append) is None
    assert lines == []


def test_a_machine_without_memory_costs_the_holes_effect_only(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def short(_: object) -> None:
        raise MemoryError("the factors need 9 GB")

    monkeypatch.setattr("flexspline.pipeline.study.holes.part_stiffness", short)
    found = holes_of(DESIGN, fast_K_e, lambda _: None)
    assert isinstance(found, UnknownEffect)
    assert "9 GB" in found.reason


@pytest.mark.parametrize(
    ("fault", "passing"),
    [
        (MemoryError(), True),
        (OutOfTimeError(0.1), True),
        (GeometryError("the keyway has no mesh"), False),
    ],
)
def test_the_effect_says_whether_more_time_or_memory_would_find_it(
    fault: Exception, passing: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    def failing(_: object) -> None:
        raise fault

    monkeypatch.setattr("flexspline.pipeline.study.holes.part_stiffness", failing)
    found = holes_of(DESIGN, fast_K_e, lambda _: None)
    assert isinstance(found, UnknownEffect)
    assert found.reason
    assert found.passing is passing


STUDY = """
design = "xb1-40.toml"
[vary]
"shaft.segment[0].length_mm" = { min = 3.5, max = 4.5, steps = 2 }
[objective]
"K_e_Nm_per_rad" = "maximize"
[run]
method = "grid"
"""


@pytest.fixture(scope="module")
def nominal_effect(tmp_path_factory: pytest.TempPathFactory) -> HolesEffect:
    study = study_of(STUDY)
    store = trial_store_of(study, tmp_path_factory.mktemp("nominal"))
    found = nominal_holes(study, store, lambda line: None)
    assert found is not None
    return found


@pytest.fixture(scope="module")
def nominal(nominal_effect: HolesEffect) -> Figures:
    """The example: figures without and with correction, and by the solid model."""
    study = study_of(STUDY)
    plain, corrected = (
        dict(figures_of(study.design, ("torsion",), h).figures) for h in (None, nominal_effect)
    )
    tables = study.design.tables
    solid = solid_answer(Task(tables, {}, ("torsion",)), rim=False).outcome
    assert not solid.reason
    return plain, corrected, dict(solid.figures)


def test_a_shaft_that_the_study_leaves_alone_has_the_solid_s_own_doubt(
    nominal: Figures, tmp_path: Path
) -> None:
    """The ratio is then exact but for both models' bounds: no share of the holes' effect beside them."""
    _, corrected, _ = nominal
    wall = STUDY.replace("shaft.segment[0].length_mm", "flexspline.length_mm").replace(
        "3.5", "25.0"
    )
    study = study_of(wall.replace("4.5", "30.0"))
    holes = nominal_holes(study, trial_store_of(study, tmp_path), lambda line: None)
    own = dict(figures_of(study.design, ("torsion",), holes).figures)
    low, high = (f"K_e_bounds_Nm_per_rad[{i}]" for i in (0, 1))
    assert low_to_high(own) < 0.5 * low_to_high(corrected)
    context = AnalysisContext(study.design, Cache(tmp_path / "solid"), Progress())
    solid = part_stiffness(context.part("shaft"))
    assert own[low] <= solid.lower_Nm_per_rad
    assert own[high] >= solid.upper_Nm_per_rad


def low_to_high(figures: dict[str, float]) -> float:
    return figures["K_e_bounds_Nm_per_rad[1]"] - figures["K_e_bounds_Nm_per_rad[0]"]


@pytest.mark.parametrize(
    ("keys", "moved"),
    [
        (("flexspline.length_mm", "material.shaft.youngs_modulus_GPa"), False),
        (("flexspline.length_mm", "shaft.segment[0].length_mm"), True),
        (("material.flexspline.poissons_ratio",), True),
    ],
)
def test_what_moves_the_ratio(keys: tuple[str, ...], moved: bool) -> None:
    assert drifts(keys) is moved


def agreed(fast: dict[str, float], solid: dict[str, float]) -> dict[str, bool]:
    checks = checked(Row(0, {}, Outcome(fast)), Outcome(solid), Solver()).checks
    return {c.key: c.agrees for c in checks}


def test_verify_agrees_with_the_correction_and_rings_without(nominal: Figures) -> None:
    plain, corrected, solid = nominal
    assert all(agreed(corrected, solid).values())
    assert not agreed(plain, solid)["K_e_Nm_per_rad"]


def test_verify_rings_where_the_holes_do_what_the_nominal_ones_do_not(nominal: Figures) -> None:
    """Twice the holes' effect, as larger holes would have it, lies beyond the widened bounds."""
    _, corrected, solid = nominal
    effect = 1 - corrected["K_e_holes_factor"]
    worse = {k: v * (1 - 2 * effect) if k.startswith("K_e") else v for k, v in solid.items()}
    assert not agreed(corrected, worse)["K_e_Nm_per_rad"]


def test_the_solid_solve_is_done_once_for_all_who_share_the_study(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = study_of(STUDY)
    monkeypatch.setattr("flexspline.pipeline.study.run.holes_of", lambda *told: HOLES)
    assert nominal_holes(study, trial_store_of(study, tmp_path), print) == HOLES
    monkeypatch.setattr(
        "flexspline.pipeline.study.run.holes_of", lambda *told: pytest.fail("solved again")
    )
    assert nominal_holes(study, trial_store_of(study, tmp_path), print) == HOLES


@pytest.mark.parametrize(
    ("passing", "begun", "again"),
    [(True, False, True), (True, True, False), (False, False, False)],
)
def test_what_the_machine_was_too_small_for_is_solved_again_until_a_design_is_begun(
    passing: bool, begun: bool, again: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rows with the effect do not stand beside rows without."""
    study, failed = study_of(STUDY), UnknownEffect("too little", passing)
    monkeypatch.setattr("flexspline.pipeline.study.run.holes_of", lambda *told: failed)
    assert nominal_holes(study, trial_store_of(study, tmp_path), print) == failed
    if begun:
        source_of(study).claim(trial_store_of(study, tmp_path), 1)
    monkeypatch.setattr("flexspline.pipeline.study.run.holes_of", lambda *told: HOLES)
    for _ in range(2):
        found = nominal_holes(study, trial_store_of(study, tmp_path), print)
        assert found == (HOLES if again else failed)


def test_a_design_without_holes_among_others_keeps_its_K() -> None:
    design = load_design(EXAMPLES / "xb1-40.toml")
    bare = design.model_copy(update={"shaft": without_holes(design).shaft})
    plain, corrected = (dict(figures_of(bare, ("torsion",), h).figures) for h in (None, HOLES))
    assert corrected == plain
    assert plain["K_e_bounds_guaranteed"]


def test_K_e_of_a_shaft_whose_holes_nobody_solved_is_no_theorem() -> None:
    design = load_design(EXAMPLES / "xb1-40.toml")
    assert not figures_of(design, ("torsion",)).figures["K_e_bounds_guaranteed"]


def test_every_design_has_an_enclosure_of_its_own() -> None:
    """Larger holes take off more; the bounds are theorems, and hold the known answer (docs/validation.md)."""
    design = load_design(EXAMPLES / "xb1-40.toml")
    larger = with_values(design, {"flexspline.bolt_hole_diameter_mm": 4.0})
    ends = []
    for one in (design, larger):
        found = figures_of(one, ("torsion",)).figures
        assert found["K_b_bounds_guaranteed"]
        ends.append([found[f"K_b_bounds_Nm_per_rad[{i}]"] for i in (0, 1)])
    assert ends[0][0] < KNOWN_K_b < ends[0][1]
    assert ends[1][0] < ends[0][0]
    assert ends[1][1] == ends[0][1]


def test_keys_that_the_fast_model_does_not_follow() -> None:
    keys = ["shaft.keyway.depth_mm", "flexspline.bolt_count", "flexspline.length_mm",
            "shaft.bolt_hole_diameter_mm"]  # fmt: skip
    assert unfollowed(keys) == (keys[0], keys[3])


def test_every_row_says_its_factor(tmp_path: Path) -> None:
    study = study_of(STUDY)
    rows = run_study(study, trial_store_of(study, tmp_path), threads, holes=HOLES).rows
    built = [r for r in rows if not r.outcome.reason]
    assert built
    factors = {
        r.values["shaft.segment[0].length_mm"]: r.outcome.figures["K_e_holes_factor"] for r in built
    }
    assert factors[4.5] < LESS < factors[3.5]  # more flange, more of it cut


def test_what_holes_add_goes_with_the_flange_s_own_compliance() -> None:
    """The same effect in softer steel; of a flange of twice the length, twice the compliance added."""
    K = fast_K_e(DESIGN).K_Nm_per_rad
    half = DESIGN.changed({"material.flexspline.youngs_modulus_GPa": 103.0})
    assert HOLES.factor(half, K / 2)[0] == pytest.approx(LESS)
    longer = DESIGN.changed({"shaft.segment[0].length_mm": 8.0})
    once, twice = (1 / HOLES.factor(d, K)[0] - 1 for d in (DESIGN, longer))
    assert twice == pytest.approx(2 * once)


@pytest.mark.parametrize(
    "lengths_mm", [(12.0, 11.0), pytest.param((4.0, 11.0), marks=pytest.mark.long)]
)
def test_a_shaft_that_is_mostly_flange_is_within_its_bounds(
    nominal_effect: HolesEffect, lengths_mm: tuple[float, float], tmp_path: Path
) -> None:
    """One factor for every shaft missed the solid model's K_e of these by 10 and 6 %."""
    keys = ("shaft.segment[0].length_mm", "shaft.segment[1].length_mm")
    design = DESIGN.changed({**dict(zip(keys, lengths_mm, strict=True)), "solver.tolerance_pct": 2})
    context = AnalysisContext(design, Cache(tmp_path), Progress())
    solid = part_stiffness(context.part("shaft"))
    fast = figures_of(design, ("torsion",), nominal_effect).figures
    low, high = (fast[f"K_e_bounds_Nm_per_rad[{i}]"] for i in (0, 1))
    assert low < solid.lower_Nm_per_rad
    assert solid.upper_Nm_per_rad < high
