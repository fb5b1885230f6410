"""A running studio and its page in a browser, for the tests beside this file."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexspline.geometry.keys import without_holes
from flexspline.geometry.load import design_from
from flexspline.geometry.template import design_text, template

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator
    from playwright.sync_api import Page as BrowserPage

VIEWPORT = {"width": 1280, "height": 800}
PATIENCE_MS = 60_000
"""A loaded machine; what is waited for takes a second on an idle one."""
UNSMOOTHED = """
const get = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, options) {
  return get.call(this, kind, options && { ...options, antialias: false });
};"""
"""Without a graphics card four samples a pixel are half of what it takes to draw the part."""


@dataclass
class Server:
    """`flexspline studio` as a process of its own."""

    process: subprocess.Popen[str]
    url: str
    design: Path
    temporary: Path | None = None

    @property
    def port(self) -> int:
        return int(re.search(r":(\d+)/", self.url)[1])

    def end(self, *, kill: bool = False) -> int:
        """Stop it; the exit status."""
        if kill:
            self.process.kill()
        else:
            self.process.terminate()
        return self.process.wait(timeout=30)


def start(design: Path, *options: str, temporary: Path | None = None) -> Server:
    """Start it, and wait for the address that it prints; `temporary`: where its jobs work."""
    ours = {} if temporary is None else {"TMPDIR": str(temporary)}
    process = subprocess.Popen(
        [sys.executable, "-m", "flexspline.results.cli", "studio", str(design), "--no-browser", *options],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=os.environ | ours,
    )  # fmt: skip
    line = process.stdout.readline()
    assert line.startswith("flexspline studio: http://"), line
    return Server(process, line.split()[-1], design, temporary)


@contextmanager
def running(design: Path, *options: str, temporary: Path | None = None) -> Iterator[Server]:
    server = start(design, *options, temporary=temporary)
    try:
        yield server
    finally:
        server.end()


def write_design(path: Path, *, holes: bool = False, name: str = "a cup") -> Path:
    """The template's cup, without its bolt holes unless they are wanted."""
    design = design_from({**tomllib.loads(template("cup")), "name": name})
    path.write_text(design_text(design if holes else without_holes(design)), encoding="utf-8")
    return path


class Page:
    """One tab of the studio; without `url` it is opened later."""

    def __init__(
        self, browser: Browser, url: str = "", init: str = UNSMOOTHED, **settings: Any
    ) -> None:
        shape = {"viewport": VIEWPORT, **settings}
        self.context = browser.new_context(accept_downloads=True, **shape)
        self.context.add_init_script(init)
        self.tab: BrowserPage = self.context.new_page()
        self.tab.set_default_timeout(PATIENCE_MS)
        self.errors: list[str] = []
        self.requests: list[str] = []
        self.tab.on("pageerror", lambda error: self.errors.append(str(error)))
        self.tab.on("request", lambda request: self.requests.append(request.url))
        if url:
            self.open(url)

    def open(self, url: str) -> None:
        self.tab.goto(url)
        self.at("#name:enabled").wait_for()

    def begin_again(self, url: str) -> None:
        """As a new tab would: half a second of computing instead of one and a half."""
        self.tab.unroute_all()
        self.tab.set_viewport_size(VIEWPORT)
        self.tab.emulate_media(media="null")
        self.tab.goto(
            f"{url.partition('?')[0]}page/theme.js"
        )  # the same origin, and no script runs
        self.tab.evaluate("sessionStorage.clear(); localStorage.clear()")
        self.errors.clear()
        self.requests.clear()
        self.open(url)

    def close(self) -> None:
        self.context.close()

    def at(self, selector: str) -> Locator:
        return self.tab.locator(selector)

    def field(self, key: str) -> Locator:
        """The number field (or text, or choice) of a design key."""
        return self.at(f'[id="f-{key}"]')

    def row(self, key: str) -> Locator:
        return self.at(f'#answers tr[data-key="{key}"]')

    def quick(self) -> None:
        """Wait until K_b, K_e and the sum belong to the design as it stands."""
        for key in ("K_b_Nm_per_rad", "K_e_Nm_per_rad", "K_series_Nm_per_rad"):
            self.at(f'#answers tr[data-key="{key}"]:not(.stale)').wait_for()

    def complete(self) -> None:
        """Wait until everything does, the picture too."""
        self.quick()
        self.at("#answers :is(tr.stale, td.rough), #gear.stale").first.wait_for(state="detached")
        self.at('#stage[data-shown^="field"]').wait_for()

    def value(self, key: str) -> float:
        """A figure with all its digits."""
        return float(self.row(key).locator("td.value").first.get_attribute("data-value"))

    def values(self, keys: Mapping[str, Any] | list[str]) -> dict[str, float]:
        return {key: self.value(key) for key in keys}

    def set(self, key: str, text: str) -> None:
        """Type a value; every figure is stale from then on until its answer comes."""
        number = self.at("#stage").get_attribute("data-number")
        self.field(key).fill(text)
        self.at(f'#stage:not([data-number="{number}"])').wait_for(state="attached")
