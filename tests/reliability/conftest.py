"""The reliability page: tests hand in what they tried, one command writes it down."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from reliability_page import Fact, page

PAGE = Path(__file__).parents[2] / "docs" / "reliability.md"
FACTS = pytest.StashKey[list[Fact]]()
OUTCOME = pytest.StashKey[str]()
PASSED = pytest.StashKey[dict[str, list[float]]]()
"""Seconds of the tests that passed, by module."""
SAID = pytest.StashKey[dict[str, str]]()
"""What each module is about, its first line."""
OPTION = "--write-reliability"
PLAIN = ("test_full_disk", "test_broken_mesher", "test_temporary_files")
"""Modules whose tests are of one kind: a row says how many passed."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(OPTION, action="store_true", help=f"write {PAGE.name} from what the tests did")


def pytest_configure(config: pytest.Config) -> None:
    config.stash[FACTS] = []
    config.stash[PASSED], config.stash[SAID] = {}, {}


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo):
    report = yield
    if report.when == "call" and report.passed:
        module = item.path.stem
        item.config.stash[PASSED].setdefault(module, []).append(report.duration)
        item.config.stash[SAID][module] = item.module.__doc__.partition("\n")[0].rstrip(".")
    return report


def plain_facts(config: pytest.Config) -> list[Fact]:
    """A row for each module whose tests hand in none of their own: how many passed."""
    own = {f.module for f in config.stash[FACTS]}
    return [
        Fact(module, config.stash[SAID][module], len(seconds), "all passed", max(seconds))
        for module, seconds in config.stash[PASSED].items()
        if module in PLAIN and module not in own
    ]


@pytest.fixture
def fact(request: pytest.FixtureRequest) -> Callable[..., None]:
    """`fact(tried, count, outcome, longest_s=None)`: a row of the reliability page."""

    def add(*words, **more) -> None:
        facts = request.config.stash.setdefault(FACTS, [])
        facts.append(Fact(request.path.stem, *words, **more))

    return add


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    config = session.config
    if not config.getoption(OPTION, default=False):
        return
    if exitstatus:
        config.stash[OUTCOME] = f"{PAGE.name} not written: tests failed"
        return
    facts = config.stash[FACTS] + plain_facts(config)
    before = PAGE.read_text(encoding="utf-8") if PAGE.exists() else ""
    PAGE.write_text(page(before, facts), encoding="utf-8")
    config.stash[OUTCOME] = f"{PAGE.name} written; rows renewed: {len(facts)}"


def pytest_terminal_summary(terminalreporter) -> None:
    if (said := terminalreporter.config.stash.get(OUTCOME, None)) is not None:
        terminalreporter.write_line(said)
