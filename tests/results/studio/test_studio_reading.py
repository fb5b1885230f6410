"""The live page for all who read it: any keyboard, any script, on paper, without WebGL, after a sleep."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import pytest
from held import HeldStudio
from pypdf import PdfReader
from studio_page import Page

from flexspline.results.studio.tab import Tab

if TYPE_CHECKING:
    from playwright.sync_api import Browser

WALL = "flexspline.wall_thickness_mm"
ESTIMATED = ("K_b_lobes_Nm_per_rad", "K_b_lobes_contact_Nm_per_rad",
             "K_b_lobes_unsupported_Nm_per_rad")  # fmt: skip
NO_WEBGL = """
const get = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return kind.startsWith("webgl") ? null : get.call(this, kind, ...rest);
};"""


@pytest.fixture(scope="module")
def kept_tab(studio_browser: Browser) -> Iterator[Page]:
    """Of `tab`, without the part's picture, which is most of a browser's work: nothing here asks for it but
    the paper, which has a tab of its own."""
    page = Page(studio_browser, init=NO_WEBGL)
    yield page
    page.close()


def test_no_estimate_is_called_guaranteed(tab: Page) -> None:
    tab.complete()
    for key in ESTIMATED:
        side = tab.row(key).locator("td.side")
        assert side.inner_text().startswith("≈"), key
        assert "guaranteed" not in tab.row(key).evaluate("row => row.outerHTML"), key
        assert "estimated" in side.get_attribute("title"), key
    for key in ("K_b_Nm_per_rad", "K_e_Nm_per_rad"):  # bounds from two variational principles
        assert not tab.row(key).locator("td.side").inner_text().startswith("≈"), key
    assert "≈ estimated" in tab.at("#answers thead").first.inner_text()


def test_without_webgl_every_figure_is_shown(held_tabs: Callable[..., Page]) -> None:
    page = held_tabs(init=NO_WEBGL)
    page.complete()
    assert "no 3-D picture" in page.at("#no-picture").inner_text()
    assert page.at("#scale li").first.inner_text()  # the stresses' scale needs none
    assert page.at("#png").is_disabled()
    page.at("#open").check()
    page.at("#reset").click()


NUMBERS = (
    ("0,45", "0.45"),
    (" 0.41 ", "0.41"),
    ("4.5e-1", "0.45"),
    ("0\u202f.41", "0.41"),
    (".45", "0.45"),
)
NO_NUMBERS = ("0x1", "1,234.5", "1,2,3", "Infinity", "1e", "0.4 mm", "--1")


def test_numbers_as_people_paste_them(tab: Page) -> None:
    """One tab for all: each is another wall than the one before."""
    tab.quick()
    for typed, taken in NUMBERS:
        tab.set(WALL, typed)
        tab.quick()
        tab.field(WALL).press("Tab")
        assert tab.field(WALL).input_value() == taken, typed  # what was understood is shown
        kept = tab.tab.evaluate("JSON.parse(sessionStorage['flexspline-design']).good")
        assert kept["flexspline"]["wall_thickness_mm"] == float(taken), typed


def test_what_is_no_number_says_so_and_stays(tab: Page) -> None:
    tab.quick()
    fault = tab.at(f'[id="f-{WALL}-fault"]')
    for i, typed in enumerate(NO_NUMBERS):
        tab.field(WALL).fill(typed)
        assert fault.inner_text() == f"{WALL}: a number is needed in mm", typed
        assert tab.field(WALL).get_attribute("aria-invalid") == "true", typed
        tab.set("load.torque_Nm", f"{1 + i}")
        tab.quick()
        assert fault.is_visible(), typed  # the field still holds no number
        tab.set(WALL, ("0.41", "0.45")[i % 2])
        tab.quick()
        assert not fault.is_visible(), typed
        assert tab.field(WALL).get_attribute("aria-invalid") is None, typed


def test_a_name_from_right_to_left(tab: Page) -> None:
    name = "تصميم הילוך \u202egear"
    tab.at("#name").fill(name)
    tab.complete()  # or the list of pinned designs is drawn again meanwhile
    assert tab.at("#name").evaluate("e => getComputedStyle(e).direction") == "rtl"
    tab.at("#pin").click()
    heading = tab.at("#pinned h2")
    assert heading.locator("bdi").inner_text() == name  # it turns no letter round outside itself
    assert heading.evaluate("e => getComputedStyle(e).direction") == "ltr"


FOCUSED = """async () => {
  // Chromium scrolls to it with the next picture
  await new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));
  const e = document.activeElement, box = e.getBoundingClientRect();
  const labels = [...(e.labels ?? [])].map((label) => label.textContent).join();
  return {
    place: e.id || e.tagName, words: (e.getAttribute("aria-label") || labels || e.textContent).trim(),
    outline: getComputedStyle(e).outlineStyle, seen: e.matches(":focus-visible"),
    inside: box.top >= -1 && box.bottom <= innerHeight + 1, body: e === document.body,
  };
}"""


@pytest.mark.parametrize("width", [1280, pytest.param(390, marks=pytest.mark.long)])
def test_by_keyboard_alone(tab: Page, width: int) -> None:
    tab.tab.set_viewport_size({"width": width, "height": 800})
    tab.quick()
    stops = []
    for _ in range(200):
        tab.tab.keyboard.press("Tab")
        stop = tab.tab.evaluate(FOCUSED)
        if stop["body"]:
            break
        stops.append(stop)
    for stop in stops:
        assert stop["words"], stop
        assert stop["seen"], stop
        assert stop["outline"] != "none", stop
        assert stop["inside"], stop
    places = [stop["place"] for stop in stops]
    assert len(set(places)) > 40
    first = "form" if width == 1280 else "stage"
    order = {
        "header": places.index("pin"), "stage": places.index("case"),
        "form": places.index(f"f-{WALL}"),
    }  # fmt: skip
    assert (
        order["header"] < order[first] == min(order["form"], order["stage"])
    )  # as the eye meets them
    tab.field(WALL).press("ArrowRight")
    before = tab.field(WALL).input_value()
    tab.at(f'.row[data-key="{WALL}"] input[type=range]').press("ArrowRight")
    assert float(tab.field(WALL).input_value()) > float(before)


def test_on_paper_are_the_name_the_part_and_every_figure(
    held_tabs: Callable[..., Page],
) -> None:
    tab = held_tabs()
    tab.at("#name").fill("a cup for paper")
    tab.complete()
    sheet = PdfReader(io.BytesIO(tab.tab.pdf(format="A4")))
    text = " ".join(page.extract_text() for page in sheet.pages).replace("\u202f", " ")
    for key in ("K_b_Nm_per_rad", "K_e_Nm_per_rad", "wave_generator_peak_mises_MPa"):
        shown = tab.row(key).locator("td.value").first.inner_text().replace("\u202f", " ")
        assert shown in text, key
    assert "New cup" not in text
    assert "Inner diameter" not in text
    tab.tab.emulate_media(media="print")
    tab.tab.evaluate("dispatchEvent(new Event('beforeprint'))")
    name, answers = tab.at("#name"), tab.at("#answers")
    assert name.is_visible()
    assert answers.evaluate("e => e.scrollHeight - e.clientHeight") <= 1
    part = tab.at("#printed")
    assert part.is_visible()
    assert part.evaluate("i => i.decode().then(() => i.naturalWidth)") > 300


def test_back_and_forward_keep_the_design(tab: Page) -> None:
    tab.quick()
    tab.set(WALL, "0.45")
    tab.quick()
    tab.tab.goto("about:blank")
    tab.tab.go_back()
    tab.quick()
    assert tab.field(WALL).input_value() == "0.45"
    assert "token" not in tab.tab.url


def test_the_token_leaves_the_address(tab: Page) -> None:
    assert tab.tab.url.endswith("/")
    assert "token" not in tab.tab.evaluate("document.referrer")
    assert tab.tab.evaluate("document.cookie") == ""  # HttpOnly


def test_a_link_on_another_page_opens_it(studio_browser: Browser, held: HeldStudio) -> None:
    context = studio_browser.new_context()
    page = context.new_page()
    page.goto(f"data:text/html,<a href='{held.url}'>open</a>")
    page.click("a")
    page.locator("#name:enabled").wait_for()
    assert page.locator("#name").input_value() == "my cup"
    context.close()


def test_a_connection_that_fell_asleep_is_made_anew(
    held_tabs: Callable[..., Page], monkeypatch: pytest.MonkeyPatch
) -> None:
    tab = held_tabs()  # a clock cannot be taken out of a tab again
    tab.complete()
    tab.tab.clock.install()
    with monkeypatch.context() as asleep:

        async def nothing(*_: object) -> None: ...

        asleep.setattr(Tab, "want", nothing)  # taken, and never answered: as a line that is dead
        tab.set(WALL, "0.45")
        tab.tab.clock.fast_forward(5_000)
        assert not tab.at("#notice").is_visible()
        tab.tab.clock.fast_forward(10_100)
        tab.at("#notice:has-text('Connection lost')").wait_for()
    tab.tab.clock.fast_forward(1_000)
    tab.at("#notice:has-text('Connected again')").wait_for()
    tab.tab.clock.resume()
    tab.quick()
    assert tab.field(WALL).input_value() == "0.45"
