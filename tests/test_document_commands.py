"""Every command that a document shows is run, in the order of its page, and says what the page says."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from contextlib import chdir
from pathlib import Path

import pytest
import typer
from document_blocks import Block, alike, blocks, missing
from finished_run import FinishedRun
from typer.testing import CliRunner

from flexspline.results.cli import app

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
RUN = [p for p in PAGES if any(b.commands for b in blocks(p))]

NOT_RUN = {
    "python3 -m venv .venv && .venv/bin/pip install . &&": "installs; .ci/run runs this very line",
    "python3 -m venv .venv && .venv/bin/pip install '.[test]' &&": "installs; .ci/run runs this one",
    "python3 -m venv .venv && . .venv/bin/activate": "leads to the next",
    "python3 -m pip install -e '.[test,docs]'": "installs; what it installs, tests/package/ installs",
    "python3 -m pytest": "this is it",
}
"""The whole list of exceptions: how a command begins, and why it is not run here."""

SHELL_SIGNS = frozenset("|<>&;$`*?~#\\")
"""What a shell makes something of; quotation marks are understood here too."""
INLINE = re.compile(r"`(flexspline [a-z]+[^`]*|python3? [\w./]+\.py[^`]*)`")


def asked(line: str, folder: Path) -> tuple[int, str]:
    """Status and words of a command; one of ours that asks nothing of a shell is answered in this process.

    How a shell starts the command, `test_cli.py` and `test_streams.py` test.
    """
    if line.startswith("flexspline ") and not set(line) & SHELL_SIGNS:
        with chdir(folder):
            done = CliRunner().invoke(app, shlex.split(line)[1:], catch_exceptions=False)
        return done.exit_code, done.stdout + done.stderr
    ended = shell(line, folder)
    return ended.returncode, ended.stdout + ended.stderr


def shell(line: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run as a reader would, `flexspline` and `python3` being those under test."""
    tools = folder / ".bin"
    path = f"{tools}{os.pathsep}{os.environ['PATH']}"
    return subprocess.run(
        ["bash", "-c", line], cwd=folder, capture_output=True, text=True, check=False,
        env={**os.environ, "PATH": path},
    )  # fmt: skip


def desk(folder: Path) -> Path:
    """A folder with a copy of the examples and the commands under test on its path."""
    ignore = shutil.ignore_patterns("*.out")
    shutil.copytree(ROOT / "examples", folder / "examples", ignore=ignore)
    tools = folder / ".bin"
    tools.mkdir()
    python = shlex.quote(sys.executable)
    for name, call in (("flexspline", f"{python} -m flexspline.results.cli"), ("python3", python)):
        (tools / name).write_text(f'#!/bin/sh\nexec {call} "$@"\n', encoding="utf-8")
        (tools / name).chmod(0o755)
    return folder


def run_page(shown: list[Block], folder: Path) -> None:
    for block in shown:
        if block.file:
            (folder / block.file).write_text(block.body, encoding="utf-8")
        for command in block.commands:
            if any(command.line.startswith(known) for known in NOT_RUN):
                continue
            status, said = asked(command.line, folder)
            refused = any(line.startswith("flexspline: ") for line in command.shown)
            assert status == (2 if refused else 0), f"{command.line}\n{said}"
            lost = missing(command.shown, said.splitlines())
            assert lost is None, f"{command.line}\nnot said: {lost}\n{said}"


@pytest.mark.parametrize("page", RUN, ids=lambda p: p.stem)
def test_commands_run_and_say_what_is_shown(
    page: Path, finished_cup: FinishedRun, tmp_path: Path
) -> None:
    run_page([b for b in blocks(page) if not b.long], desk(tmp_path))


LONG = [p for p in RUN if any(b.long for b in blocks(p))]


@pytest.mark.long
@pytest.mark.parametrize("page", LONG, ids=lambda p: p.stem)
def test_the_long_commands_too(page: Path, tmp_path: Path) -> None:
    run_page(list(blocks(page)), desk(tmp_path))


def test_the_exceptions_are_all_needed() -> None:
    lines = [c.line for p in PAGES for b in blocks(p) for c in b.commands]
    for known in NOT_RUN:
        assert any(line.startswith(known) for line in lines), known


def test_the_text_names_commands() -> None:
    """The next test passes on a page without any."""
    named = [line for page in PAGES for line in INLINE.findall(page.read_text(encoding="utf-8"))]
    assert any(line.startswith("flexspline") for line in named)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)
def test_commands_named_in_the_text_exist(page: Path) -> None:
    """Commands and options in running text, with places for the reader's own files, exist."""
    group = typer.main.get_command(app)
    for line in INLINE.findall(page.read_text(encoding="utf-8")):
        words = shlex.split(line, comments=True)
        if words[0] != "flexspline":
            assert (ROOT / words[1]).exists(), line
            continue
        options = {o for p in group.commands[words[1]].params for o in p.opts} | {"--help"}
        assert {w for w in words if w.startswith("--")} <= options, line


def test_links_and_pictures_of_the_pages_exist() -> None:
    targets = [
        (page, target)
        for page in PAGES
        for target in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text(encoding="utf-8"))
        if "://" not in target
    ]
    assert targets
    for page, target in targets:
        assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_the_comparison_sees_other_words_and_other_numbers() -> None:
    said = ["  K_b   31 377 N·m/rad", "between", "  total  84.7 arcsec", "end"]
    assert missing(["K_b 31 500 N·m/rad", "...", "total 84.6 arcsec"], said) is None
    assert missing(["K_b 31 900 N·m/rad"], said) is not None  # beyond 1 %
    assert missing(["K_b 31 377 N·m/rad", "total 84.7 arcsec"], said) is not None  # a line between
    assert missing(["total 84.7 arcsec", "...", "K_b 31 377 N·m/rad"], said) is not None  # order
    assert missing(["total 84.7 N·m/rad"], said) is not None
    assert not alike("−0.428", "0.428")
