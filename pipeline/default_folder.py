"""The default output folder."""

from pathlib import Path


def default_folder(file: Path) -> Path:
    """Return the folder NAME.out beside the file NAME.toml."""
    return file.parent / f"{file.stem}.out"
