"""The default output folder."""

from pathlib import Path


def default_folder(file: Path) -> Path:
    """NAME.out beside the file NAME.toml."""
    return file.parent / f"{file.stem}.out"
