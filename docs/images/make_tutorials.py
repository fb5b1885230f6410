"""Makes the pictures of the tutorials and of the README's diagnosis: runs the commands, shrinks the pictures.

python3 docs/images/make_tutorials.py
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from PIL import Image

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
WIDTH = 1000
MAKING = ("init", "run", "study", "diagnose")
README_DIAGNOSIS = "diagnose examples/xb1-40.toml examples/measured/xb1-40-sweep.csv --out example"
PICTURES = {
    "example/causes.png": "xb1-40-causes.png",
    "design.out/wave_generator.png": "tutorial-wave-generator.png",
    "design.out/backlash_budget.png": "tutorial-budget.png",
    "length.out/pareto.png": "tutorial-pareto.png",
    "found/measured_and_predicted.png": "tutorial-measured.png",
    "found/causes.png": "tutorial-causes.png",
}


def main() -> None:
    """Run what makes the pictures, then copy them."""
    sys.path[:0] = [str(ROOT / "tests" / "helpers"), str(ROOT / "tests")]
    from document_blocks import blocks
    from test_document_commands import desk, shell

    with tempfile.TemporaryDirectory() as name:
        folder = desk(Path(name))
        shell(f"flexspline {README_DIAGNOSIS}", folder)
        for page in ("tutorial-designer.md", "tutorial-test-engineer.md"):
            for block in blocks(ROOT / "docs" / page):
                if block.file:
                    (folder / block.file).write_text(block.body, encoding="utf-8")
                for command in block.commands:
                    if any(f" {word} " in command.line for word in MAKING):
                        print(command.line, file=sys.stderr)
                        shell(command.line, folder)
        for made, kept in PICTURES.items():
            save_small(folder / made, HERE / kept)


def save_small(made: Path, kept: Path) -> None:
    """WIDTH pixels wide."""
    with Image.open(made) as picture:
        height = round(picture.height * WIDTH / picture.width)
        small = picture.convert("RGB").resize((WIDTH, height), Image.Resampling.LANCZOS)
        small.save(kept, optimize=True)


if __name__ == "__main__":
    main()
