"""Without an installation the tests take flexspline from the checkout."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
NOT_INSTALLED = """
import importlib.util, os, sys
importlib.util.find_spec = lambda name: None
import checkout, flexspline
print(flexspline.__file__, os.environ["PYTHONPATH"].split(os.pathsep)[0], sep="\\n")
"""


@pytest.mark.skipif(os.name != "posix", reason="the checkout's link is Unix's")
def test_what_is_not_installed_is_the_checkouts_own() -> None:
    env = {**os.environ, "PYTHONPATH": str(ROOT / "tests" / "helpers")}
    words = [sys.executable, "-c", NOT_INSTALLED]
    said = subprocess.run(words, env=env, capture_output=True, text=True, check=True, cwd="/")
    link = ROOT / ".ci" / "editable"
    assert said.stdout.split("\n")[:2] == [str(link / "flexspline" / "__init__.py"), str(link)]


def test_the_folder_around_the_checkout_is_not_searched_for_modules() -> None:
    """Else a folder there that is called as a library would be imported in its place."""
    assert str(ROOT.parent) not in sys.path
    assert ROOT.name == "flexspline" or ROOT.name not in sys.modules
