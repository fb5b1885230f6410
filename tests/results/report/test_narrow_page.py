"""The page of a diagnosis on a telephone."""

from __future__ import annotations

from pathlib import Path

from browser import chromium
from example_files import EXAMPLES
from typer.testing import CliRunner

from flexspline.results.cli import app

TELEPHONE_px = 420


def test_every_column_of_a_diagnosis_is_in_sight(tmp_path: Path) -> None:
    words = ("diagnose", EXAMPLES / "xb1-40.toml", EXAMPLES / "measured" / "xb1-40-sweep.csv")
    options = ("--Kb", 31329, "--Ke", 43339, "--out", tmp_path)
    assert CliRunner().invoke(app, [str(w) for w in (*words, *options)]).exit_code == 0
    with chromium() as browser:
        page = browser.new_page(viewport={"width": TELEPHONE_px, "height": 800})
        page.goto((tmp_path / "diagnosis.html").as_uri())
        beyond = page.evaluate(
            "[...document.querySelectorAll('.wide')].map(w => w.scrollWidth - w.clientWidth)"
        )
    assert beyond
    assert max(beyond) <= 0
