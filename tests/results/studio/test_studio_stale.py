"""One figure, one design: what belongs to a former one is grey until its own comes, and never flashes."""

from __future__ import annotations

import time
from typing import Any

import pytest
from held import HeldStudio
from studio_page import PATIENCE_MS, Page

WALL = "flexspline.wall_thickness_mm"
GREY = 0.6
"""Opacity; at most so much is left to a figure of a former design."""
WATCH = """() => {
  const opacity = (e) => (e ? Number(getComputedStyle(e).opacity) * opacity(e.parentElement) : 1);
  window.seen = [];
  const look = () => {
    const shown = [...document.querySelectorAll("#answers td.value, #brief > div, #scale")]
      .filter((e) => e.textContent && e.textContent !== "…" && e.checkVisibility());
    window.seen.push(Math.max(...shown.map(opacity)));
    window.watching = requestAnimationFrame(look);
  };
  look();
}"""
END = "() => { cancelAnimationFrame(window.watching); return window.seen; }"


def hold_wall(held: HeldStudio, wall_mm: float, *but: str) -> None:
    """Keep back all answers of the designs with this wall, but those to these questions."""

    def hold(question: str, tables: dict[str, Any]) -> bool:
        return tables["flexspline"]["wall_thickness_mm"] == wall_mm and question not in but

    held.hold = hold


def test_figures_of_a_former_design_are_grey_in_every_frame(tab: Page, held: HeldStudio) -> None:
    tab.complete()
    held.hold = lambda question, tables: True
    tab.tab.evaluate(WATCH)
    tab.tab.wait_for_timeout(100)
    assert tab.tab.evaluate("window.seen.at(-1)") == 1  # of this design
    tab.set(WALL, "0.41")
    tab.tab.evaluate("window.seen = []")
    # all that draws the answers again
    for value in ("0.42", "0.43", "0.44"):
        tab.set(WALL, value)
        tab.tab.wait_for_timeout(250)
    tab.at("#pin").click()
    tab.tab.wait_for_timeout(250)
    tab.at("#pin").click()
    tab.tab.wait_for_timeout(250)
    seen = tab.tab.evaluate(END)
    assert len(seen) > 10
    assert max(seen) <= GREY


@pytest.mark.long
def test_a_late_answer_is_grey_too(tab: Page, held: HeldStudio) -> None:
    tab.complete()
    before = tab.value("K_b_Nm_per_rad")
    hold_wall(held, 0.41)
    asked: list[float] = []
    kept = held.hold

    def hold(question: str, tables: dict[str, Any]) -> bool:
        if question == "torsion":
            asked.append(tables["flexspline"]["wall_thickness_mm"])
        return kept(question, tables)

    held.hold = hold
    tab.set(WALL, "0.45")
    ends = time.monotonic() + PATIENCE_MS / 1e3
    while (
        0.45 not in asked and time.monotonic() < ends
    ):  # a busy page asks only for what it has last
        tab.tab.wait_for_timeout(20)
    assert 0.45 in asked
    tab.set(WALL, "0.41")
    late = f'#answers tr[data-key="K_b_Nm_per_rad"] td.value:not([data-value="{before!r}"])'
    tab.at(late).first.wait_for()
    tab.tab.evaluate(WATCH)
    tab.tab.wait_for_timeout(300)
    assert max(tab.tab.evaluate(END)) <= GREY
    held.hold = lambda question, tables: False
    tab.complete()
    assert tab.at("#answers .stale, #brief .stale").count() == 0
    assert tab.at("#stage.former").count() == 0


@pytest.mark.long
def test_beside_a_newly_opened_design_the_former_one_s_figures_are_grey(
    tab: Page, held: HeldStudio
) -> None:
    tab.at("#new-hat").click()
    tab.at("#left-out").wait_for()
    tab.complete()
    stress = tab.at("#scale li").first.inner_text()
    held.hold = lambda question, tables: tables["flexspline"]["kind"] == "cup"
    tab.at("#new-cup").click()
    tab.field("flexspline.flange_thickness_mm").wait_for(state="detached")
    tab.tab.evaluate(WATCH)
    tab.tab.wait_for_timeout(400)
    assert max(tab.tab.evaluate(END)) <= GREY
    assert tab.at("#scale li").first.inner_text() == stress
    held.hold = lambda question, tables: False
    tab.complete()
    assert tab.at("#scale li").first.inner_text() != stress


def test_a_fault_shows_the_last_design_that_can_be_built_and_no_third(
    tab: Page, held: HeldStudio
) -> None:
    tab.complete()
    first = tab.value("K_b_Nm_per_rad")
    tab.at("#pin").click()
    # of the second design K_b and K_e are known, of the first still the rest
    hold_wall(held, 0.45, "torsion")
    tab.set(WALL, "0.45")
    tab.quick()
    second = tab.value("K_b_Nm_per_rad")
    assert second != first
    tab.set("flexspline.inner_fillet_mm", "30")
    tab.at("#whose:has-text('last design that can be built')").wait_for()
    assert tab.value("K_b_Nm_per_rad") == second
    assert tab.row("K_b_lobes_contact_Nm_per_rad").locator("td.value").inner_text() == "…"
    assert tab.row("wave_generator_peak_mises_MPa").locator("td.value").inner_text() == "…"
    assert not tab.at("#canvas").is_visible()  # the picture is the first design's
    assert tab.at("#answers td.delta").count() == 0
    assert not tab.at("#pinned").is_visible()
    tab.tab.evaluate(WATCH)
    tab.tab.wait_for_timeout(300)
    assert max(tab.tab.evaluate(END)) <= GREY
    # the rest of the second design comes meanwhile, and its picture in another view
    held.hold = lambda question, tables: False
    tab.at(
        '#answers tr[data-key="shaft_torque_peak_mises_MPa"] td.value:not(:has-text("…"))'
    ).wait_for()
    tab.at("#case").select_option("shaft_torque")
    tab.at('#stage[data-shown^="field shaft_torque"]').wait_for()
    assert tab.at("#canvas").is_visible()
    tab.tab.evaluate(WATCH)
    tab.tab.wait_for_timeout(100)
    assert max(tab.tab.evaluate(END)) <= GREY
    tab.set("flexspline.inner_fillet_mm", "1")
    tab.complete()
    assert not tab.at("#whose").is_visible()
    assert tab.value("K_b_Nm_per_rad") == second


def test_a_text_that_is_no_number_leaves_no_figure_black(tab: Page) -> None:
    tab.complete()
    tab.field(WALL).fill("wide")
    tab.at(".row .fault:visible").wait_for()
    tab.tab.evaluate(WATCH)
    tab.tab.wait_for_timeout(200)
    assert max(tab.tab.evaluate(END)) <= GREY
    assert "last design that can be built" in tab.at("#whose").inner_text()


def test_only_figures_of_one_design_are_pinned(tab: Page, held: HeldStudio) -> None:
    tab.complete()
    hold_wall(held, 0.41, "torsion")
    tab.set(WALL, "0.41")
    tab.quick()
    tab.at("#pin").click()
    tab.set(WALL, "0.45")
    held.hold = lambda question, tables: (
        False
    )  # what comes late of the pinned design is not waited for
    tab.complete()
    delta = tab.row("K_b_Nm_per_rad").locator("td.delta")
    assert delta.inner_text().startswith("+")
    # never known of the pinned design: no difference is made up
    assert tab.row("K_b_lobes_contact_Nm_per_rad").locator("td.delta").count() == 0
