"""Makes the README's picture of a report: runs the example and photographs report.html in Chromium.

python3 docs/images/make_report_picture.py
"""

from __future__ import annotations

import io
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
VIEWPORT = {"width": 1000, "height": 1240}
WIDTH, GAP = 1200, 20


def main() -> None:
    """The first page in light, the stress in dark, side by side."""
    sys.path.insert(0, str(ROOT / "tests" / "helpers"))
    from browser import chromium

    with tempfile.TemporaryDirectory() as name:
        design = str(ROOT / "examples" / "xb1-40.toml")
        command = [sys.executable, "-m", "flexspline.results.entry", "run", design, "--out", name]
        subprocess.run(command, check=True, cwd=ROOT, stdout=subprocess.DEVNULL)
        with chromium() as browser:
            shots = []
            for scheme, at in (("light", "header"), ("dark", "h2:has(+ .figures .view)")):
                context = browser.new_context(viewport=VIEWPORT, color_scheme=scheme, offline=True)
                page = context.new_page()
                page.goto((Path(name) / "report.html").as_uri())
                page.wait_for_selector("html[data-views=ready]", state="attached")
                page.evaluate(
                    "at => [...document.querySelectorAll(at)].at(-1).scrollIntoView()", at
                )
                page.wait_for_timeout(500)
                shots.append(Image.open(io.BytesIO(page.screenshot())).convert("RGB"))
                context.close()
    width = sum(s.width for s in shots) + GAP
    sheet = Image.new("RGB", (width, shots[0].height), "white")
    sheet.paste(shots[0], (0, 0))
    sheet.paste(shots[1], (shots[0].width + GAP, 0))
    small = sheet.resize((WIDTH, round(sheet.height * WIDTH / width)), Image.Resampling.LANCZOS)
    small.save(HERE / "xb1-40-report.png", optimize=True)


if __name__ == "__main__":
    main()
