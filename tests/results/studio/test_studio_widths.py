"""The live page in windows from 320 to 2560 pixels: nothing cut off, nothing over anything else."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from held import HeldStudio
from studio_page import Page

WINDOWS = ((2560, 1440), (1280, 800), (768, 1024), (390, 844), (320, 640))
NARROWEST = ((1280, 800), (320, 640))
"""Of each layout, beside and below one another, the one with the least room."""
BETWEEN = ((1024, 768), (844, 390), (640, 400))
"""The last is 1280 × 800 at 200 % zoom."""
PLACES = (
    "button, input, select, a, summary, label, td, th, h2, .unit, .brand, .fault, #canvas, "
    "#scale .bars, #caption p, #busy:not(:empty), #brief > div, #whose, #agreement, svg.line, svg.stack"
)
FAULTS = """(places) => {
  const shown = (e) => e.checkVisibility() && e.getBoundingClientRect().width > 0;
  const all = [...document.querySelectorAll(places)].filter(shown);
  const boxes = all.map((e) => e.getBoundingClientRect());
  const name = (e) => `${e.tagName} ${e.id || e.className} ${e.textContent.slice(0, 30)}`;
  const whole = "button, td.value, td.what, th, #brief dd";
  const cut = (e) => e.matches(whole) && e.scrollWidth > e.clientWidth + 1;
  // the scale lies on the picture's own ground, where the part leaves room
  const apart = (e, f) => e.contains(f) || f.contains(e) || (e.id === "canvas" && f.closest("#scale"));
  const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1.5
    && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1.5;
  const found = [];
  const wide = document.scrollingElement.scrollWidth;
  if (wide > innerWidth) found.push(`the page is ${wide} wide`);
  const room = document.getElementById("name").clientWidth;
  if (room < 110) found.push(`the name has ${room} pixels`);
  all.forEach((e, i) => {
    const a = boxes[i];
    if (a.left < -0.5 || a.right > innerWidth + 0.5) found.push(`${name(e)} ends at ${a.right}`);
    if (cut(e)) found.push(`${name(e)} is cut off`);
    for (let k = i + 1; k < all.length; k++) {
      if (meet(a, boxes[k]) && !apart(e, all[k])) found.push(`${name(e)} lies on ${name(all[k])}`);
    }
  });
  return found;
}"""
FRAMES = 20
"""Times 150 ms: what is wrong three seconds after a window was resized stays wrong."""
LONG = "Strain wave gear with a mounting flange, third revision " * 3


def looks_right(page: Page, state: str, windows: tuple[tuple[int, int], ...] = WINDOWS) -> None:
    """At every width; all that is wrong is named at once."""
    found: dict[str, Any] = {}
    for width, height in windows:
        page.tab.set_viewport_size({"width": width, "height": height})
        for _ in range(
            FRAMES
        ):  # the picture takes its size a frame later, on a busy machine after a while
            page.tab.wait_for_timeout(150)
            faults = page.tab.evaluate(FAULTS, PLACES)
            if not faults:
                break
        else:
            found[f"{state} at {width} × {height}"] = faults[:6]
    assert found == {}


def test_before_any_answer(tab: Page, held: HeldStudio) -> None:
    held.hold = lambda question, tables: True
    tab.tab.reload()
    tab.at("#answers tr.stale").first.wait_for()
    looks_right(tab, "start", NARROWEST)


@pytest.mark.parametrize("windows", [WINDOWS, pytest.param(BETWEEN, marks=pytest.mark.long)])
def test_with_every_answer(tab: Page, windows: tuple[tuple[int, int], ...]) -> None:
    tab.complete()
    looks_right(tab, "complete", windows)
    tab.at("#tab-measured").click()
    looks_right(tab, "measured", windows)


@pytest.mark.long  # before the first ones by default
def test_while_answers_are_awaited(tab: Page, held: HeldStudio) -> None:
    tab.complete()
    held.hold = lambda question, tables: True
    tab.set("flexspline.wall_thickness_mm", "0.41")
    looks_right(tab, "busy")


@pytest.mark.long  # of a hat by default: the next test
def test_with_a_fault(tab: Page) -> None:
    tab.complete()
    tab.set("flexspline.inner_fillet_mm", "30")
    tab.at(".row .fault:visible").wait_for()
    looks_right(tab, "error")


@pytest.mark.parametrize(
    "windows", [NARROWEST, pytest.param((*WINDOWS, *BETWEEN), marks=pytest.mark.long)]
)
def test_a_hat_with_holes_and_a_long_name(tab: Page, windows: tuple[tuple[int, int], ...]) -> None:
    tab.at("#new-hat").click()
    tab.field("flexspline.flange_thickness_mm").wait_for()
    tab.at("#name").fill(LONG)
    tab.at("#left-out").wait_for()
    tab.complete()
    looks_right(tab, "hat", windows)
    tab.set("flexspline.inner_fillet_mm", "30")
    tab.at(".row .fault:visible").wait_for()
    looks_right(tab, "hat, error", windows)


def test_beside_a_pinned_design(tab: Page) -> None:
    tab.complete()
    tab.at("#pin").click()
    tab.set("flexspline.wall_thickness_mm", "0.41")
    tab.complete()
    looks_right(tab, "pinned", NARROWEST)


def test_one_column_begins_with_the_answers_and_keeps_them_in_sight(tab: Page) -> None:
    tab.complete()
    tab.tab.set_viewport_size({"width": 390, "height": 844})
    tops = [
        tab.at(place).bounding_box()["y"] for place in ("#brief", "#stage", "#answers", "#form")
    ]
    assert tops == sorted(tops)
    tab.field("load.torque_Nm").scroll_into_view_if_needed()
    brief = tab.at("#brief").bounding_box()
    assert 0 <= brief["y"] < 10
    figure, _bounds = tab.row("K_b_Nm_per_rad").locator("td.value").inner_text().splitlines()
    assert figure in tab.at("#brief").inner_text()


@pytest.mark.parametrize("width", [390, pytest.param(768, marks=pytest.mark.long)])
def test_a_finger_can_move_a_slider_and_scroll_past_the_part(
    held_tabs: Callable[..., Page], width: int
) -> None:
    page = held_tabs(has_touch=True, is_mobile=True, viewport={"width": width, "height": 844})
    page.complete()  # what comes later moves the slider from under the finger
    slider = page.at('.row[data-key="flexspline.wall_thickness_mm"] input[type=range]')
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    assert box["height"] >= 24  # WCAG 2.2, target size (minimum)
    page.tab.touchscreen.tap(box["x"] + 0.9 * box["width"], box["y"] + box["height"] / 2)
    page.at("#stage:not([data-number='1'])").wait_for()
    assert float(page.field("flexspline.wall_thickness_mm").input_value()) > 0.5
    for place in ("#canvas canvas", ".row input[type=range]"):
        assert page.at(place).first.evaluate("e => getComputedStyle(e).touchAction") == "pan-y"
