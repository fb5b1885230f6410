"""The live page and the studio's own process: figures as the command's, a solid solve, a killed process.

The process and its workers start once for all of these; what the page does with answers: the other files.
"""

from __future__ import annotations

import json
import os
import time
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING

import in_process
import pytest
from studio_page import Page, Server, start

import flexspline
from flexspline.geometry.keys import without_holes
from flexspline.geometry.load import design_from, load_design
from flexspline.geometry.template import template

if TYPE_CHECKING:
    from playwright.sync_api import Browser

WALL = "flexspline.wall_thickness_mm"
STIFFNESSES = (
    "K_b_Nm_per_rad", "K_b_lobes_Nm_per_rad", "K_b_lobes_contact_Nm_per_rad",
    "K_b_lobes_unsupported_Nm_per_rad", "K_e_Nm_per_rad", "K_series_Nm_per_rad",
)  # fmt: skip
SAME = 1e-7
"""The page solves for 1 GPa and scales, the command for the material: one answer but for rounding, of
which an unsupported rim, floppy as it is, keeps nine digits."""


DRAG = """async (key) => {  // until both have moved often enough; a slow machine has twelve seconds
  const slider = document.querySelector(`.row[data-key="${key}"] input[type=range]`);
  const figures = new Set(), pictures = new Set();
  for (let i = 0; i < 240 && (figures.size < 4 || pictures.size < 3); i++) {
    slider.value = String(0.3 + 0.003 * (i % 60));
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    await new Promise((done) => setTimeout(done, 50));
    figures.add(document.querySelector('#answers tr[data-key="K_b_Nm_per_rad"] td.value').textContent);
    pictures.add(document.getElementById("stage").dataset.shown);
  }
  return [figures.size, pictures.size];
}"""


@pytest.mark.long
def test_figures_and_picture_move_while_a_slider_does(page: Page) -> None:
    page.complete()
    figures, pictures = page.tab.evaluate(DRAG, WALL)
    # an answer that waited for the hand to rest would show two: before and after
    assert figures >= 4
    assert pictures >= 3
    page.complete()
    wall, last = page.field(WALL).input_value(), page.value("K_b_Nm_per_rad")
    page.set(WALL, "0.4")
    page.quick()
    page.set(WALL, wall)
    page.complete()
    assert page.value("K_b_Nm_per_rad") == last  # whatever came late, the last design's stays


def test_the_figures_equal_the_command_line_s(page: Page, tmp_path: Path) -> None:
    page.set("solver.tolerance_pct", "5")  # both solve alike, and sooner
    page.set(WALL, "0.43")
    page.set("material.flexspline.youngs_modulus_GPa", "201.5")
    page.complete()
    with page.tab.expect_download() as waiting:
        page.at("#save").click()
    saved = tmp_path / "saved.toml"
    waiting.value.save_as(saved)
    assert load_design(saved).flexspline.wall_thickness_mm == 0.43
    out = tmp_path / "out"
    done = in_process.flexspline("stiffness", saved, "--json", "--out", out, folder=tmp_path)
    record = json.loads(done.stdout)
    assert page.values([*STIFFNESSES, "wave_generator_peak_mises_MPa"]) == pytest.approx(
        {key: record[key] for key in (*STIFFNESSES, "wave_generator_peak_mises_MPa")}, rel=SAME
    )
    given = ["--Kb", record["K_b_Nm_per_rad"], "--Ke", record["K_e_Nm_per_rad"]]
    done = in_process.flexspline("backlash", saved, *given, "--json", "--out", out, folder=tmp_path)
    terms = json.loads(done.stdout)["backlash_arcsec"]
    for term in ("shaft", "flexspline", "flank_clearance", "bearing_play", "total"):
        assert page.value(f"backlash_arcsec.{term}") == pytest.approx(terms[term], rel=SAME)
    assert f"± {terms['std']:.1f}" in page.row("backlash_arcsec.total").inner_text()


@pytest.mark.long
def test_the_whole_gear_follows_and_equals_the_command_s(page: Page) -> None:
    page.complete()
    before = page.value("K1_Nm_per_rad")
    race = "wave_generator.race_thickness_mm"
    assert page.field(race).input_value() == ""  # the design leaves it to its default
    page.set(race, "0.9")
    page.complete()
    design = design_from(tomllib.loads(template("cup")))
    gear = flexspline.gear(without_holes(design).changed({race: 0.9}))
    assert page.value("K1_Nm_per_rad") == pytest.approx(gear.K1_Nm_per_rad, rel=SAME)
    assert page.value("lost_motion_arcsec") == pytest.approx(gear.lost_motion_arcsec, rel=SAME)
    assert page.value("K1_Nm_per_rad") > before  # a stiffer race
    page.set(race, "")
    page.complete()
    assert page.value("K1_Nm_per_rad") == before


def commands_running(studio: Server) -> list[int]:
    """Processes that work in a folder of this studio's (Linux)."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            where = os.readlink(entry / "cwd") if entry.name.isdigit() else ""
        except OSError:
            continue
        if where and studio.temporary and Path(where).is_relative_to(studio.temporary):
            found.append(int(entry.name))
    return found


def solving(page: Page, studio: Server) -> None:
    """Press, and wait until the solid solve is at work."""
    page.at("#work-solid").click()
    page.at("#progress-solid:has-text('mesh of the flexspline')").wait_for()
    if Path("/proc").is_dir():
        assert commands_running(studio)
    assert page.at("#work-solid").inner_text() == "Stop"


def ends_soon(studio: Server) -> bool:
    ends = time.monotonic() + 15
    while commands_running(studio) and time.monotonic() < ends:
        time.sleep(0.2)
    return commands_running(studio) == []


@pytest.mark.long
def test_a_solid_solve_shows_its_progress_and_ends_by_stop_reload_and_close(
    page: Page, studio: Server
) -> None:
    page.quick()
    page.set("solver.tolerance_pct", "0.011")  # minutes of work, were it not stopped
    solving(page, studio)
    page.at("#work-solid").click()
    page.at("#progress-solid:has-text('stopped')").wait_for()
    assert page.at("#work-solid").inner_text() != "Stop"
    assert commands_running(studio) == []

    solving(page, studio)
    page.tab.reload()
    page.quick()
    assert page.at("#work-solid").inner_text() == "Solve with the solid model"
    assert ends_soon(studio)

    solving(page, studio)
    page.close()
    assert ends_soon(studio)


def test_a_server_killed_and_started_again_is_found(
    studio_browser: Browser, studio: Server
) -> None:
    """Last: it ends what the others were served by, and leaves its successor in its place."""
    page = Page(studio_browser, studio.url)
    try:
        page.quick()
        page.set("flexspline.wall_thickness_mm", "0.47")
        page.quick()
        before = page.value("K_b_Nm_per_rad")
        studio.end(kill=True)
        page.at("#notice:has-text('Connection lost')").wait_for()
        page.field("flexspline.length_mm").fill("31")
        second = start(studio.design, "--port", str(studio.port), temporary=studio.temporary)
        studio.process = second.process
        page.at("#notice:has-text('open the printed address')").wait_for()
        page.context.new_page().goto(second.url)  # its cookie is the first tab's too
        page.at("#notice:has-text('Connected again')").wait_for()
        page.quick()
        assert page.field("flexspline.wall_thickness_mm").input_value() == "0.47"
        assert page.value("K_b_Nm_per_rad") < before  # what was typed meanwhile counts: longer
    finally:
        page.close()
