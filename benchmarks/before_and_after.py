"""Whole commands of two installations in turn, each with a cold cache: what a change costs or gains.

    python benchmarks/before_and_after.py OLD_FLEXSPLINE NEW_FLEXSPLINE [--rounds 3] [COMMAND ...]

Both are paths of the command `flexspline`; a COMMAND is quoted, as "stiffness examples/hat-25.toml". Prints
a table: the median of each, and their ratio, which holds on a slower machine too.
"""

from __future__ import annotations

import argparse
import shlex
import statistics
import tempfile
from pathlib import Path

from cases import ROOT
from measure import run

COMMANDS = (
    "stiffness examples/hat-25.toml",
    "stiffness examples/xb1-40.toml",
    "stiffness examples/keyed-shaft.toml",
    "run examples/xb1-40.toml",
)
"""Of the issue that asked for their time; the designs are this tree's, for both."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("commands", nargs="*", default=COMMANDS)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_intermixed_args()
    print("| command | old, s | new, s | new / old | old, MB | new, MB |")
    print("|---|---|---|---|---|---|")
    for command in options.commands:
        pairs = [
            (timed(options.old, command), timed(options.new, command))
            for _ in range(options.rounds)
        ]
        old_s, new_s = (statistics.median(p[i]["wall_s"] for p in pairs) for i in (0, 1))
        old_MB, new_MB = (max(p[i]["peak_MB"] for p in pairs) for i in (0, 1))
        print(
            f"| `{command}` | {old_s:.1f} | {new_s:.1f} | {new_s / old_s:.2f} | {old_MB} | {new_MB} |"
        )


def timed(program: str, command: str) -> dict[str, float]:
    """Wall clock [s] and peak memory [MB] of one command with an empty cache."""
    verb, *arguments = shlex.split(command)
    paths = [str(ROOT / a) if (ROOT / a).exists() else a for a in arguments]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        extra = {"FLEXSPLINE_CACHE": str(folder / "cache")}
        found = run([program, verb, *paths, "--json", "--out", str(folder / "out")], folder, extra)
    if "failed" in found:
        raise SystemExit(f"{program} {command}: {found['failed']}")
    return found


if __name__ == "__main__":
    main()
