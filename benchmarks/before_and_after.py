"""Whole commands of two installations in turn, each with a cold cache: what a change costs or gains.

    python benchmarks/before_and_after.py OLD_FLEXSPLINE NEW_FLEXSPLINE [--rounds 3] [COMMAND ...]

Both are paths of the command `flexspline`; a COMMAND is quoted, as "stiffness examples/hat-25.toml". Prints
a table: the median of each, and their ratio, which holds on a slower machine too.
"""

from __future__ import annotations

import argparse
import shlex
import tempfile
from pathlib import Path

from cases import ROOT
from measure import repeated, run

COMMANDS = (
    "stiffness examples/hat-25.toml",
    "stiffness examples/xb1-40.toml",
    "stiffness examples/keyed-shaft.toml",
    "run examples/xb1-40.toml",
)
"""The designs are this tree's, for both."""


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
        old, new = map(repeated, zip(*pairs, strict=True))
        walls = f"{old['wall_s']:.1f} | {new['wall_s']:.1f} | {new['wall_s'] / old['wall_s']:.2f}"
        print(f"| `{command}` | {walls} | {old['peak_MB']} | {new['peak_MB']} |")


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
