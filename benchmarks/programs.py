"""One run of each program on a case: a whole process from start to K."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from cases import QUARTER_DEG, WEDGE_DEG, Case
from measure import run

HERE = Path(__file__).parent
COMMAND = str(Path(sys.executable).with_name("flexspline"))
SHAFT_GIVEN = "1e5"
"""With K_e given, `flexspline backlash` solves for K_b alone."""


@dataclass(frozen=True)
class Setting:
    """Of a peer: lengths in mm, `edge` along the circles where the stress is singular."""

    order: int
    maxh: float
    edge: float
    grading: float

    def __str__(self) -> str:
        return f"order {self.order}, h {self.maxh:g}/{self.edge:g} mm, grading {self.grading:g}"


@dataclass(frozen=True)
class Peer:
    """A peer program on the whole cup or on a sector; `python` has NGSolve."""

    name: str
    script: str
    sector: float
    python: str

    def run(self, case: Case, setting: Setting, steps: Path) -> dict[str, Any]:
        options = asdict(setting) | {"sector": self.sector, "patches": case.patches()}
        options["load"] = case.load
        words = [str(w) for k, v in options.items() for w in (f"--{k}", v)]
        step = case.step(steps, self.sector)
        with tempfile.TemporaryDirectory() as folder:
            command = [self.python, str(HERE / self.script), str(step), *words]
            return run(command, Path(folder))


def peers(python: str, case: Case) -> tuple[Peer, ...]:
    """Those that solve the case: lobes and ellipse have the symmetry of a quarter."""
    if case.load != "uniform":
        return (Peer("NGSolve, quarter", "peer_ngsolve.py", QUARTER_DEG, python),)
    return (
        Peer("NGSolve, wedge", "peer_ngsolve.py", WEDGE_DEG, python),
        Peer("NGSolve, full", "peer_ngsolve.py", 360.0, python),
        Peer("CalculiX, full", "peer_calculix.py", 360.0, python),
    )


def ours(case: Case, tolerance_pct: float) -> dict[str, Any]:
    """`flexspline backlash` with K_e given; a load case of the rim alone by the same functions."""
    if case.load != "uniform":
        script = str(HERE / "rim_alone.py")
        return _solved([sys.executable, script, "design.toml", case.load], case, tolerance_pct)
    options = ["--Ke", SHAFT_GIVEN, "--json", "--out", "out"]
    found = _solved([COMMAND, "backlash", "design.toml", *options], case, tolerance_pct)
    return found if "failed" in found else _figures(found)


def stiffness_command(case: Case, tolerance_pct: float) -> dict[str, Any]:
    """`flexspline stiffness`: every load case of both parts."""
    command = [COMMAND, "stiffness", "design.toml", "--json", "--out", "out"]
    found = _solved(command, case, tolerance_pct)
    return found if "failed" in found else _figures(found)


def _solved(command: list[str], case: Case, tolerance_pct: float) -> dict[str, Any]:
    """A command of ours run beside its design.toml, with an empty cache."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "design.toml").write_text(case.design_text(tolerance_pct), encoding="utf-8")
        return run(command, folder, {"FLEXSPLINE_CACHE": str(folder / "cache")})


def _figures(found: Mapping[str, Any]) -> dict[str, Any]:
    low, high = found["K_b_bounds_Nm_per_rad"]
    K, solver = found["K_b_Nm_per_rad"], found["solver"]
    return {
        "K": K, "bound_pct": 50 * (high - low) / K, "unknowns": solver["dofs"],
        "elements": solver["elements"], "model": solver["model"],
        "bounds_kind": found["K_b_bounds_kind"],
        "wall_s": found["wall_s"], "cpu_s": found["cpu_s"], "peak_MB": found["peak_MB"],
    }  # fmt: skip
