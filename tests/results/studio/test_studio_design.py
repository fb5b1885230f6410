"""The live page in a real browser: sliders, figures, the part in 3-D, bad values, pinning, two tabs.

`tab` is a tab of a server in this process, which keeps its answers (`held.py`).
"""

from __future__ import annotations

import io
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from PIL import Image
from studio_page import Page

from flexspline.geometry.load import design_from

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Route

WALL = "flexspline.wall_thickness_mm"
CUT = """all => all.filter(e => e.clientWidth && e.scrollWidth > e.clientWidth + 1)
  .map(e => e.textContent)"""


def pixels(part: Locator) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(part.screenshot())).convert("RGB")).astype(int)


def test_a_slider_moves_and_the_figures_follow(tab: Page) -> None:
    page = tab
    page.complete()
    before = page.value("K_b_Nm_per_rad")
    shaft = page.value("K_e_Nm_per_rad")
    slider = page.at('.row[data-key="flexspline.wall_thickness_mm"] input[type=range]')
    for _ in range(5):
        slider.press("ArrowRight")
    page.quick()
    assert float(page.field(WALL).input_value()) > 0.4
    # a tube's stiffness grows about as its wall
    assert page.value("K_b_Nm_per_rad") > before * (1 + 0.2 * 0.005 / 0.4)
    assert page.value("K_e_Nm_per_rad") == shaft
    page.set("load.torque_Nm", "1")
    page.quick()
    assert page.value("backlash_arcsec.shaft") == pytest.approx(2 / shaft * 206264.806, rel=1e-6)


@pytest.mark.long
def test_the_part_turns_and_is_coloured(tab: Page) -> None:
    tab.complete()
    part = tab.at("#canvas")
    before = pixels(part)
    # from the dark to the bright end of the scale: its ends are blue-violet and yellow
    assert ((before[..., 2] - before[..., 1]) > 30).any()
    assert ((before[..., 0] - before[..., 2]) > 60).any()
    # as bright as the scale, whose yellow has 253 of red: lit from the eye, not from behind (below 210)
    ring = before[100:, : before.shape[1] * 3 // 4]  # the scale lies right of it
    assert ring[..., 0][ring[..., 2] < 90].max() > 225
    box = part.bounding_box()
    mouse = tab.tab.mouse
    mouse.move(box["x"] + 200, box["y"] + 300)
    mouse.down()
    mouse.move(box["x"] + 320, box["y"] + 260, steps=4)
    mouse.up()
    tab.tab.wait_for_timeout(700)  # the turning runs out
    turned = pixels(part)
    assert (np.abs(turned - before).max(axis=2) > 20).mean() > 0.02
    tab.at("#open").check()
    tab.tab.wait_for_timeout(300)
    assert (np.abs(pixels(part) - turned).max(axis=2) > 20).mean() > 0.02
    tab.at("#case").select_option("shaft_torque")
    tab.at('#stage[data-shown^="field shaft_torque"]').wait_for()


def test_bad_values_are_explained_where_they_are_typed(tab: Page) -> None:
    tab.complete()
    kept = tab.value("K_b_Nm_per_rad")
    tab.set("flexspline.inner_fillet_mm", "30")
    fault = tab.at('.row[data-key="flexspline.inner_fillet_mm"] .fault')
    fault.wait_for()
    assert "flexspline.inner_fillet_mm = 30.0: must be from 0 to" in fault.inner_text()
    tab.at("#answers tr.stale").first.wait_for()
    assert tab.value("K_b_Nm_per_rad") == kept
    tab.field("flexspline.inner_fillet_mm").fill("wide")
    tab.at(
        '.row[data-key="flexspline.inner_fillet_mm"] .fault:has-text("a number is needed")'
    ).wait_for()
    tab.set("bearing.radial_clearance_um", "9000")
    tab.set("flexspline.inner_fillet_mm", "1")
    tab.at('.row[data-key="bearing.radial_clearance_um"] .fault').wait_for()
    tab.set("bearing.radial_clearance_um", "12")
    tab.quick()
    assert not fault.is_visible()


def test_the_name_takes_no_text_before_the_design_has_come(tab: Page) -> None:
    held: list[Route] = []
    tab.tab.route("**/start", lambda route: held.append(route))
    with tab.tab.expect_request("**/start"):
        tab.tab.reload()
    name = tab.at("#name")
    assert name.is_disabled()  # what went in now would be written over by what comes
    held[0].continue_()
    name.fill("in time")
    tab.quick()
    assert name.input_value() == "in time"
    assert tab.tab.title().startswith("in time")


def test_a_name_is_only_text(tab: Page) -> None:
    for name in ("<script>alert(1)</script><img src=x onerror=alert(1)>", '#read("/etc/passwd")'):
        tab.at("#name").fill(name)
        tab.quick()
        tab.at("#pin").click()
        tab.at("#pinned h2").wait_for()
        assert tab.at("#pinned h2").inner_text() == f"Pinned: {name}"
        assert tab.tab.title().startswith(name)
        assert tab.at("#pinned script, #pinned img").count() == 0
        tab.at("#pin").click()  # let go
        tab.at("#pinned h2").wait_for(state="hidden")


def test_a_pinned_design_is_compared(tab: Page) -> None:
    tab.complete()
    before = tab.value("K_b_Nm_per_rad")
    tab.at("#pin").click()
    tab.set(WALL, "0.44")
    tab.quick()
    after = tab.value("K_b_Nm_per_rad")
    shown = tab.row("K_b_Nm_per_rad").locator("td.delta").inner_text()
    assert f"+{after - before:.0f}" in shown
    assert f"+{100 * (after / before - 1):.1f} %" in shown
    assert tab.at("#pinned tr").inner_text().split() == [WALL, "0.4", "→", "0.44"]


def test_two_tabs_do_not_disturb_each_other(tab: Page, held_tabs: Callable[..., Page]) -> None:
    one, two = tab, held_tabs()
    one.quick()
    two.quick()
    before = two.value("K_b_Nm_per_rad")
    one.set(WALL, "0.45")
    one.quick()
    one.tab.wait_for_timeout(300)
    assert two.value("K_b_Nm_per_rad") == before < one.value("K_b_Nm_per_rad")
    assert two.field(WALL).input_value() == "0.4"
    one.tab.reload()
    one.quick()
    assert one.field(WALL).input_value() == "0.45"  # kept in its own tab


def test_designs_are_opened_and_their_tables_come_and_go(tab: Page, tmp_path: Path) -> None:
    tab.quick()
    tab.at("#new-hat").click()
    tab.field("flexspline.flange_thickness_mm").wait_for()
    tab.at("#left-out:has-text('12 bolt holes of the flexspline')").wait_for()
    tab.at("button:has-text('Add keyway')").click()
    tab.field("shaft.keyway.width_mm").wait_for()
    with tab.tab.expect_download() as waiting:
        tab.at("#save").click()
    saved = tomllib.loads(Path(waiting.value.path()).read_text(encoding="utf-8"))
    assert design_from(saved).shaft.keyway is not None
    tab.quick()
    alone = "without holes and keyway"
    assert alone in tab.row("K_e_Nm_per_rad").inner_text()
    assert alone not in tab.row("K_b_Nm_per_rad").inner_text()
    tab.tab.set_viewport_size({"width": 390, "height": 844})
    assert alone in tab.at("#brief").inner_text()
    broken = tmp_path / "broken.toml"
    broken.write_text("name = 1\n[flexspline\n", encoding="utf-8")
    with tab.tab.expect_file_chooser() as chooser:
        tab.at("#load").click()
    chooser.value.set_files(broken)
    tab.at("#notice:has-text('is not valid TOML')").wait_for()
    broken.write_bytes(b"#" * 1_000_001)
    with tab.tab.expect_file_chooser() as chooser:
        tab.at("#load").click()
    chooser.value.set_files(broken)
    tab.at("#notice:has-text('at most 1 MB')").wait_for()
    assert tab.field("shaft.keyway.width_mm").is_visible()  # what was there still is


def test_everything_important_is_in_sight(tab: Page) -> None:
    for width, height in ((1280, 800), (1920, 1080)):
        tab.tab.set_viewport_size({"width": width, "height": height})
        tab.complete()
        tab.tab.wait_for_timeout(150)  # the picture takes its size a frame later
        in_sight(tab, width, height)
    # nothing from outside
    assert all(request.startswith(tab.tab.url) for request in tab.requests)


def in_sight(tab: Page, width: int, height: int) -> None:
    shown = ("#tools", "#form", "#stage", "#stagebar", "#scale", "#caption", "#solid",
             "#answers tr.total", "#answers svg.line:not(.gearline)")  # fmt: skip
    boxes = {name: tab.at(name).bounding_box() for name in shown}
    for name, box in boxes.items():
        assert box["x"] >= 0, name
        assert box["x"] + box["width"] <= width, name
        assert box["y"] + box["height"] <= height, name
    for place in ("#form label", "#answers td", "#answers .limit", "header button"):
        assert tab.at(place).evaluate_all(CUT) == [], place
    bar, scale = boxes["#stagebar"], boxes["#scale"]
    assert bar["y"] + bar["height"] <= scale["y"]
    assert scale["y"] + scale["height"] <= boxes["#caption"]["y"]


def test_light_and_dark(held_tabs: Callable[..., Page]) -> None:
    dark, light = held_tabs(color_scheme="dark"), held_tabs(color_scheme="light")
    ground = [
        p.at("body").evaluate("b => getComputedStyle(b).backgroundColor") for p in (dark, light)
    ]
    assert ground[0] != ground[1]
    light.at("#theme").click()
    light.at("#theme").click()
    assert light.at("#theme").inner_text() == "Dark"
    assert light.at("body").evaluate("b => getComputedStyle(b).backgroundColor") == ground[0]
