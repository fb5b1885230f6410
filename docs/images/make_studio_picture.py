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
    """The example cup in light, complete, at 1280 by 1000, so that the whole gear shows."""
    sys.path.insert(0, str(ROOT / "tests" / "helpers"))
    from browser import chromium
    from studio_page import Page, running

    with running(ROOT / "examples" / "xb1-40.toml") as server, chromium() as browser:
        room = {"width": 1280, "height": 1000}
        page = Page(
            browser, server.url, color_scheme="light", device_scale_factor=SCALE, viewport=room
        )
        page.complete()
        page.tab.wait_for_timeout(1000)
        shot = Image.open(io.BytesIO(page.tab.screenshot())).convert("RGB")
        page.close()
    shot.save(HERE / "xb1-40-studio.png", optimize=True)


if __name__ == "__main__":
    main()
