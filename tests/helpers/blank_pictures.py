"""Pictures for reports that nobody drew: one colour, under the names that a run gives its own."""

from __future__ import annotations

from pathlib import Path

from PIL import Image

from flexspline.results.file_names import CHARTS, RENDERED


def blank_pictures(
    folder: Path, width: int = 160, height: int = 120, prefix: str = ""
) -> dict[str, Path]:
    """PNG files in `folder`, one for each picture of a run, by its name."""
    paths = {name: folder / f"{prefix}{name}.png" for name in (*RENDERED, *CHARTS)}
    for path in paths.values():
        Image.new("RGB", (width, height), (200, 210, 220)).save(path)
    return paths
