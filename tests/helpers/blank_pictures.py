"""Pictures for reports that nobody drew: one colour, under the names that a run gives its own."""

from __future__ import annotations

from pathlib import Path

from PIL import Image

NAMES = (
    "flexspline_mesh", "shaft_mesh", "flexspline_torque", "shaft_torque", "wave_generator",
    "backlash_budget", "torque_angle", "convergence", "gear_torque_angle", "gear_loads",
)  # fmt: skip


def blank_pictures(
    folder: Path, width: int = 160, height: int = 120, prefix: str = ""
) -> dict[str, Path]:
    """PNG files in `folder`, one for each picture of a run, by its name."""
    paths = {name: folder / f"{prefix}{name}.png" for name in NAMES}
    for path in paths.values():
        Image.new("RGB", (width, height), (200, 210, 220)).save(path)
    return paths
