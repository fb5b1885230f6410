"""docs/ as a site: builds without a warning, has every page, opens from a folder without network."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    out = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "-q",
         "-f", str(ROOT / ".ci" / "mkdocs.yml"), "-d", str(folder)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert out.returncode == 0, out.stderr  # strict: a dead link or a page without a place fails
    return folder


def test_every_page_is_there_with_its_pictures(site: Path) -> None:
    for page in (ROOT / "docs").glob("*.md"):
        built = (site / page.with_suffix(".html").name).read_text(encoding="utf-8")
        for source in re.findall(r'<img[^>]* src="([^"]+)"', built):
            assert (site / source).exists(), f"{page.name}: {source}"


def test_pages_load_nothing_from_elsewhere(site: Path) -> None:
    loads = re.compile(
        r'<(?:script|img|iframe)[^>]* src="?(https?:)?//|<link[^>]* href="?(?:https?:)?//'
    )
    for page in site.rglob("*.html"):
        assert not loads.search(page.read_text(encoding="utf-8")), page.name
    for sheet in site.rglob("*.css"):
        assert not re.search(
            r"(url\(|@import )['\"]?(https?:)?//", sheet.read_text(encoding="utf-8")
        )
