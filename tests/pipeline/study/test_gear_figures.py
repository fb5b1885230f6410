"""K1, K2, K3 and lost motion in studies: the same as `flexspline gear`, also of bearings not stated."""

from __future__ import annotations

import pytest
from example_files import EXAMPLES
from study_bench import GRID, study_of

import flexspline
from flexspline.geometry.keys import with_values
from flexspline.pipeline.study.evaluate import STUDY_TORSION_WIDTH, Task, evaluate
from flexspline.pipeline.study.figures import needed
from flexspline.pipeline.study.source import solves_of
from flexspline.pipeline.study.study import StudyError

HOLE_FREE = flexspline.load_design(EXAMPLES / "xb1-40.toml").changed(
    {"shaft.bolt_count": 0, "flexspline.bolt_count": 0}
)
RACE = "wave_generator.race_thickness_mm"


def test_a_row_says_what_the_command_says() -> None:
    values = {RACE: 0.6, "wave_generator.ball_count": 20.0}
    task = Task(HOLE_FREE.tables, values, ("torsion", "gear"))
    row = evaluate(task)
    assert row.reason == ""
    gear = flexspline.gear(with_values(HOLE_FREE, values))
    # the shaft is solved to another tolerance, and is a part of the compliance
    same = pytest.approx(gear.K2_Nm_per_rad, rel=STUDY_TORSION_WIDTH)
    assert row.figures["K2_Nm_per_rad"] == same
    assert row.figures["lost_motion_arcsec"] == pytest.approx(
        gear.lost_motion_arcsec, rel=STUDY_TORSION_WIDTH
    )
    assert row.figures["teeth_in_contact"] == gear.teeth_in_contact


def test_a_gear_that_cannot_be_loaded_costs_only_its_own_figures() -> None:
    play = {
        "bearing.radial_clearance_um": 450.0,  # more than twice the stroke of 0.2 mm
        "bearing.bearing_play_model": "small_displacement",
    }
    task = Task(HOLE_FREE.tables, play, ("torsion", "gear"))
    row = evaluate(task)
    assert "gear: bearing.radial_clearance_um" in row.reason
    assert "K_b_Nm_per_rad" in row.figures
    assert "K2_Nm_per_rad" not in row.figures


def test_a_name_that_begins_like_figures_is_answered_with_the_first() -> None:
    with pytest.raises(StudyError, match="did you mean K2_Nm_per_rad"):
        study_of(GRID.replace('"K_b_Nm_per_rad"', '"K2"'))


def test_it_is_solved_only_where_it_is_asked_for() -> None:
    assert "gear" not in needed(["K_b_Nm_per_rad"], ("torsion",))
    asked = study_of(GRID.replace('"K_b_Nm_per_rad"', '"K2_Nm_per_rad"'))
    assert "gear" in solves_of(asked, ("torsion",))


def test_what_the_design_file_leaves_to_its_default_can_be_varied_but_cannot_scatter() -> None:
    """No value to scatter about: it has to be stated first."""
    varied = study_of(GRID.replace("flexspline.wall_thickness_mm", RACE))
    assert RACE in varied.keys
    scattered = (
        f'design = "xb1-40.toml"\n[tolerance]\n"{RACE}" = {{ plus_minus = 0.01 }}\n'
        '[run]\nmethod = "tolerance"\n'
    )
    with pytest.raises(StudyError, match="has no value in the design file"):
        study_of(scattered)
    with pytest.raises(StudyError, match="is not a number in the design file"):
        study_of(GRID.replace("flexspline.wall_thickness_mm", "shaft.keyway.depth_mm"))


def test_jammed_teeth_are_in_the_row() -> None:
    """So that a study which wants little lost motion can keep out gears that do not run."""
    tables = HOLE_FREE.tables
    short, full = (
        evaluate(Task(tables, {"wave_generator.deflection_mm": stroke}, ("torsion", "gear")))
        for stroke in (0.13, 0.2)
    )
    assert short.figures["preload_tooth_force_N"] > 0
    assert full.figures["preload_tooth_force_N"] == 0
    assert short.figures["lost_motion_arcsec"] < full.figures["lost_motion_arcsec"]
