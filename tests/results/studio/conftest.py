"""One browser and one studio for all tests of the page."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from browser import chromium
from held import HeldStudio, held_studio
from studio_page import Page, Server, running, write_design

from flexspline.geometry.keys import with_values, without_holes
from flexspline.geometry.load import design_from
from flexspline.geometry.template import template

if TYPE_CHECKING:
    from playwright.sync_api import Browser


@pytest.fixture(scope="module")
def studio_browser() -> Iterator[Browser]:
    with chromium() as browser:
        yield browser


@pytest.fixture(scope="module")
def studio(studio_browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A studio of a cup without holes, so that the fast model leaves nothing out."""
    folder = tmp_path_factory.mktemp("studio")
    with running(write_design(folder / "design.toml"), temporary=folder) as server:
        yield server
    assert [path.name for path in folder.iterdir()] == ["design.toml"]  # jobs leave no folder


@contextmanager
def tabs(browser: Browser, url: str) -> Iterator[Callable[..., Page]]:
    """Opens tabs; afterwards they are closed, and none may have met an error."""
    pages: list[Page] = []

    def make(**settings: Any) -> Page:
        pages.append(Page(browser, url, **settings))
        return pages[-1]

    yield make
    for page in pages:
        page.close()
    assert [error for page in pages for error in page.errors] == []


@pytest.fixture
def opened(studio: Server, studio_browser: Browser) -> Iterator[Callable[..., Page]]:
    with tabs(studio_browser, studio.url) as make:
        yield make


@pytest.fixture
def page(opened: Callable[..., Page]) -> Page:
    return opened()


@pytest.fixture(scope="module")
def held(studio_browser: Browser, suite_folder: Path) -> Iterator[HeldStudio]:
    """A studio in this process whose answers a test can hold back. None is computed twice in a suite:
    tests that need no figure of their own take walls of 0.41 and 0.45 mm."""
    cup = without_holes(design_from(tomllib.loads(template("cup"))))
    with held_studio(with_values(cup, {"solver.tolerance_pct": 5.0}), suite_folder) as studio:
        yield studio


@pytest.fixture
def held_tabs(held: HeldStudio, studio_browser: Browser) -> Iterator[Callable[..., Page]]:
    """Opens tabs of it; afterwards nothing is held."""
    with tabs(studio_browser, held.url) as make:
        yield make
        held.hold = lambda question, tables: False


@pytest.fixture(scope="module")
def kept_tab(held: HeldStudio, studio_browser: Browser) -> Iterator[Page]:
    page = Page(studio_browser)
    yield page
    page.close()


@pytest.fixture
def tab(kept_tab: Page, held: HeldStudio) -> Iterator[Page]:
    """A tab of it that begins as a new one does; of settings of its own or with a clock: `held_tabs`."""
    kept_tab.begin_again(held.url)
    yield kept_tab
    kept_tab.tab.goto("about:blank")  # first: what was held is then wanted no more
    held.hold = lambda question, tables: False
    assert kept_tab.errors == []
