"""report.html in a real browser, offline: its views turn, its policy holds, it works without WebGL."""

import io
import json
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from blank_pictures import blank_pictures
from browser import chromium
from hand_made_gear import content, design
from hand_made_tube import LENGTH, OUTER, field, oval, tube, twisted
from PIL import Image

from flexspline.results.renders.ellipse_picture import turning_ellipse
from flexspline.results.renders.stress_picture import turning_torque_stress
from flexspline.results.report.attached import Attachment
from flexspline.results.report.page import WORDS, page_of, png
from flexspline.results.report.sections import run_document

NASTY = '</script><script>window.hacked = 1</script><img src=x onerror="window.hacked = 1">'
VIEWS = ("flexspline_torque", "shaft_torque", "wave_generator")


@pytest.fixture(scope="module")
def browser():
    with chromium() as made:
        yield made


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """A whole report on a small tube, its design named to do harm."""
    folder = tmp_path_factory.mktemp("page")
    paths = blank_pictures(folder)
    made = content(design=design(name=NASTY), pictures=paths, warnings=(NASTY,))
    mesh = tube(30.0, 2)
    torque = field(mesh, twisted(mesh.nodes), (OUTER, 0.0, LENGTH))
    ellipse = field(mesh, oval(mesh.nodes), (OUTER, 0.0, LENGTH))
    views = {
        name: turning_torque_stress(torque, part, 0.5)
        for name, part in (("flexspline_torque", "Flexspline"), ("shaft_torque", "Output shaft"))
    } | {"wave_generator": turning_ellipse(ellipse, 0.2)}
    images = {n: png(p) for n, p in made.pictures.items()}
    path = folder / "report.html"
    path.write_bytes(page_of(run_document(made), images, views))
    return path, views


@contextmanager
def opened(browser, path, scheme="light", script=""):
    """The page with the network cut off; nothing may have been asked for or complained about."""
    context = browser.new_context(
        viewport={"width": 1280, "height": 900}, color_scheme=scheme, offline=True
    )
    asked, complaints = [], []
    try:
        page = context.new_page()
        page.on("request", lambda r: asked.append(r.url))
        page.on("pageerror", lambda e: complaints.append(str(e)))
        page.on("console", lambda m: complaints.append(m.text) if m.type == "error" else None)
        if script:
            page.add_init_script(script)
        page.goto(path.as_uri())
        yield page
        assert [u for u in asked if not u.startswith("data:")] == [path.as_uri()]
        assert complaints == []
    finally:
        context.close()


def pixels(page, view):
    shot = page.locator(f"[data-view={view}] .stage").screenshot()
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)


def differing(one, other):
    return (np.abs(one - other).max(axis=2) > 24).mean()


def soon(page, view, met):
    """Whether the view's pixels soon are as wanted; a loaded machine lags."""
    for _ in range(40):
        if met(pixels(page, view)):
            return True
        page.wait_for_timeout(100)
    return False


def becomes(page, view, first, met):
    """Whether the share of pixels that differ from `first` soon is as wanted."""
    return soon(page, view, lambda image: met(differing(first, image)))


def turned(share):
    return share > 0.03


def as_before(share):
    return share < 0.002  # the antialiased rim of the button's focus ring, if anything


def coloured(image):
    """The share of a view that shows the part."""
    return (np.ptp(image, axis=2) > 60).mean()


def ready(page):
    page.wait_for_selector("html[data-views=ready]", state="attached", timeout=60_000)


@pytest.mark.parametrize(
    "views",
    # one script turns all; the ellipse, whose view has more to it, is turned by keys
    [VIEWS[:1], pytest.param(VIEWS[1:], marks=pytest.mark.long)],
    ids=["first", "others"],
)
def test_views_turn_offline(browser, report, views):
    path, _ = report
    with opened(browser, path) as page:
        ready(page)
        for view in views:
            stage = page.locator(f"[data-view={view}] .stage")
            stage.scroll_into_view_if_needed()
            first = pixels(page, view)
            assert coloured(first) > 0.05  # the tube is there, in the map's colours
            box = stage.bounding_box()
            x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
            page.mouse.move(x, y)
            page.mouse.down()
            page.mouse.move(x + 90, y + 40, steps=4)
            page.mouse.up()
            page.mouse.move(0, 0)
            assert becomes(page, view, first, turned)
            page.locator(f"[data-view={view}] .reset").click()
            assert becomes(page, view, first, as_before)
        assert page.evaluate("window.hacked") is None
        assert page.locator("h1 + p").inner_text() == NASTY


def test_keys_turn_and_the_page_scrolls_over_a_view(browser, report):
    path, views = report
    with opened(browser, path) as page:
        ready(page)
        stage = page.locator("[data-view=wave_generator] .stage")
        stage.focus()
        first = pixels(page, "wave_generator")
        for _ in range(3):
            page.keyboard.press("ArrowLeft")
        assert becomes(page, "wave_generator", first, turned)
        page.keyboard.press("Home")
        assert becomes(page, "wave_generator", first, as_before)
        stage.hover()
        before = page.evaluate("scrollY")
        page.mouse.wheel(0, -200)
        for _ in range(40):
            if page.evaluate("scrollY") < before:
                break
            page.wait_for_timeout(100)
        assert page.evaluate("scrollY") < before
        assert becomes(page, "wave_generator", first, as_before)  # scrolled, not zoomed
        # the mark stands where the peak is: the label and its ring lie inside the stage
        said = json.loads(views["wave_generator"])["mark"]["text"]
        flag = page.locator("[data-view=wave_generator] .flag")
        assert flag.inner_text() == said
        inner, outer = flag.bounding_box(), stage.bounding_box()
        assert outer["x"] <= inner["x"] <= outer["x"] + outer["width"]


@pytest.mark.long
def test_hands_move_and_zoom_a_view(browser, report):
    """Shift and drag moves the part, a wheel zooms once the view is taken, so do two fingers; one turns."""
    path, _ = report
    view = "shaft_torque"
    with opened(browser, path) as page:
        ready(page)
        stage = page.locator(f"[data-view={view}] .stage")
        stage.scroll_into_view_if_needed()
        first = pixels(page, view)
        box = stage.bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        ring = page.locator(f"[data-view={view}] .ring")
        place = ring.bounding_box()

        def back():
            page.locator(f"[data-view={view}] .reset").click()
            assert becomes(page, view, first, as_before)

        page.keyboard.down("Shift")
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 30, y, steps=4)
        page.mouse.up()
        page.keyboard.up("Shift")
        # the mark moves with the part; a drag runs out to within a pixel
        assert soon(page, view, lambda _: abs(ring.bounding_box()["x"] - place["x"] - 30) < 1)
        assert ring.bounding_box()["y"] == pytest.approx(place["y"], abs=1)
        assert becomes(page, view, first, turned)
        back()
        page.mouse.click(x, y)
        page.mouse.wheel(0, -400)
        assert soon(page, view, lambda image: coloured(image) > 1.1 * coloured(first))
        back()
        hand = page.context.new_cdp_session(page)

        def touch(kind, *fingers):
            points = [{"x": a, "y": b, "id": i} for i, (a, b) in enumerate(fingers)]
            hand.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        touch("touchStart", (x, y))
        for step in range(1, 7):
            touch("touchMove", (x + 15 * step, y))
        touch("touchEnd")
        assert becomes(page, view, first, turned)
        assert coloured(pixels(page, view)) < 1.3 * coloured(first)
        back()
        touch("touchStart", (x - 30, y), (x + 30, y))
        for step in range(1, 7):
            touch("touchMove", (x - 30 - 5 * step, y), (x + 30 + 5 * step, y))
        touch("touchEnd")
        assert soon(page, view, lambda image: coloured(image) > 1.3 * coloured(first))
        back()


def test_dark_light_and_print(browser, report):
    path, _ = report
    grounds = {}
    for scheme in ("light", "dark"):
        with opened(browser, path, scheme) as page:
            ready(page)
            grounds[scheme] = pixels(page, "shaft_torque")[3, 3].mean()
            if scheme == "dark":
                page.emulate_media(media="print")
                assert page.locator(".view").first.is_hidden()
                assert page.locator("figure.turns img").first.is_visible()
                assert page.evaluate("getComputedStyle(document.querySelector('main')).color") == (
                    "rgb(31, 36, 41)"
                )
    assert grounds["light"] > 240
    assert grounds["dark"] < 80


def brightness(page, picture):
    """Mean of the pixels that a picture's corner shows, 0 to 255, as a person sees them."""
    shot = Image.open(io.BytesIO(page.locator(picture).first.screenshot())).convert("L")
    return np.asarray(shot)[4:12, 4:12].mean()


def test_charts_are_dark_on_a_dark_page_and_white_on_paper(browser, tmp_path):
    """White ground and red ink, as a chart has them."""
    chart = tmp_path / "chart.png"
    image = Image.new("RGB", (160, 120), "white")
    image.paste((179, 55, 31), (60, 40, 100, 80))
    image.save(chart)
    path = tmp_path / "r.html"
    made = content(pictures={"backlash_budget": chart, "wave_generator": chart})
    path.write_bytes(
        page_of(run_document(made), {"backlash_budget": png(chart), "wave_generator": png(chart)})
    )
    with opened(browser, path) as page:
        assert brightness(page, "img.chart") > 250
    with opened(browser, path, "dark") as page:
        assert brightness(page, "img.chart") < 40  # the page's own ground is 26 of 255
        assert brightness(page, "img.stress") < 215  # its colours mean stress: dimmed, not turned
        shot = Image.open(io.BytesIO(page.locator("img.chart").screenshot())).convert("RGB")
        red, green, blue = shot.getpixel((shot.width // 2, shot.height // 2))
        assert red > max(green, blue) + 30  # red stays red
        page.emulate_media(media="print")
        assert brightness(page, "img.chart") > 250


def test_a_page_gives_back_the_design_file(browser, tmp_path):
    """Opened from a folder, offline: a click saves the file, byte for byte."""
    data = "name = 'Größe'\r\n".encode()
    path = tmp_path / "r.html"
    made = content(attached=(Attachment("d.toml", data, "Design file"),))
    path.write_bytes(page_of(run_document(made), {}))
    with opened(browser, path) as page:
        page.locator("summary").click()
        assert page.locator("pre").inner_text().strip() == "name = 'Größe'"
        with page.expect_download() as saved:
            page.locator("a[download]").click()
        assert saved.value.suggested_filename == "d.toml"
        assert Path(saved.value.path()).read_bytes() == data


def test_without_webgl_the_pictures_stay(browser, report):
    path, _ = report
    none = "HTMLCanvasElement.prototype.getContext = () => null;"
    with opened(browser, path, script=none) as page:
        page.wait_for_timeout(500)  # what the viewer does of its own accord comes after 0.1 s
        assert page.locator("input").count() == 0
        assert page.locator(".view:visible").count() == 0
        assert page.locator("figure.turns img:visible").count() == 3
        assert WORDS["reset"] not in page.locator("main").inner_text()
