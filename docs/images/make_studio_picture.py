"""Makes the README's picture of the live page: starts it on the example and photographs it in Chromium.

python3 docs/images/make_studio_picture.py
"""

from __future__ import annotations

import io
import sys
from pathlib import Path

from PIL import Image

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
SCALE = 1.25


def main() -> None:
    """The example cup in light, complete, as at 1280 by 800."""
    sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "results" / "studio")]
    from browser import chromium
    from studio_page import Page, running

    with running(ROOT / "examples" / "xb1-40.toml") as server, chromium() as browser:
        page = Page(browser, server.url, color_scheme="light", device_scale_factor=SCALE)
        page.complete()
        page.tab.wait_for_timeout(1000)
        shot = Image.open(io.BytesIO(page.tab.screenshot())).convert("RGB")
        page.close()
    shot.save(HERE / "xb1-40-studio.png", optimize=True)


if __name__ == "__main__":
    main()
