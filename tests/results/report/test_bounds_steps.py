"""How bounds were found, step by step, as the report lists it."""

from __future__ import annotations

from hand_made_gear import content

from flexspline.results.report.document import Bullets
from flexspline.results.report.mesh_and_solver import mesh_and_solver, steps_of


def test_a_method_of_several_steps_is_a_list() -> None:
    method = (
        "recovery estimate; K is the finest mesh's; bounds: from less to more (never stiffer; 1 %)"
    )
    assert steps_of(method) == (
        "Recovery estimate.",
        "K is the finest mesh's.",
        "Bounds: from less to more (never stiffer; 1 %).",
    )


def test_a_method_of_one_step_is_a_sentence() -> None:
    assert steps_of("energy bounds from both sides") == ("Energy bounds from both sides.",)


def test_times_of_stages_are_apart_from_the_commas_in_their_names() -> None:
    said = content(stage_seconds={"lobes, rim held": 8.1, "torsion": 0.2})
    text = str(list(mesh_and_solver(said, roomy=False)))
    assert "lobes, rim held 8.1 s; torsion 0.2 s" in text
    assert not any(
        isinstance(b, Bullets) and not b.items for b in mesh_and_solver(said, roomy=False)
    )
