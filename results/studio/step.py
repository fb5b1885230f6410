"""`python -m flexspline.results.studio.step DESIGN.toml DIR`: both parts as STEP, nothing solved."""

from __future__ import annotations

import sys
from pathlib import Path

from flexspline.geometry.load import load_design
from flexspline.pipeline.progress import Progress
from flexspline.results.export import write_cad
from flexspline.results.job import answered, tell


def main() -> None:
    """Two arguments: the design file and the folder."""
    path, folder = map(Path, sys.argv[1:])
    with answered(path):
        write_cad(load_design(path), folder, Progress(tell))


if __name__ == "__main__":
    main()
