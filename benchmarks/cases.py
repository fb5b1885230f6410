"""The two cups that everybody computes: design files, STEP files, and where their patches are."""

from __future__ import annotations

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
CUP = ROOT / "examples" / "xb1-40.toml"
ACCURACIES_PCT = (1.0, 0.5, 0.1)
WEDGE_DEG = 30.0


@dataclass(frozen=True)
class Case:
    """A cup; `holes` 0 makes it a body of revolution."""

    name: str
    title: str
    holes: int

    def design_text(self, tolerance_pct: float | None = None) -> str:
        text = CUP.read_text(encoding="utf-8")
        text = text.replace("bolt_count = 6", f"bolt_count = {self.holes}")
        return text + (f"\n[solver]\ntolerance_pct = {tolerance_pct}\n" if tolerance_pct else "")

    def step(self, folder: Path, sector_deg: float) -> Path:
        """The STEP file of the whole flexspline or a wedge, written once."""
        path = folder / f"{self.name}-{sector_deg:g}.step"
        if not path.exists():
            from flexspline.geometry.cad import build_solid, write_step
            from flexspline.geometry.load import design_from

            design = design_from(tomllib.loads(self.design_text()))
            write_step(build_solid(design.part("flexspline"), sector_deg), path)
        return path

    def patches(self) -> str:
        """What a peer needs to find the patches among the STEP file's faces, as JSON (mm, MPa)."""
        data = tomllib.loads(self.design_text())
        f, m = data["flexspline"], data["material"]["flexspline"]
        ring_end = f["length_mm"] - f["ring_offset_mm"]
        found: dict[str, Any] = {
            "holes": self.holes,
            "hole_radius": f["bolt_hole_diameter_mm"] / 2,
            "bore_radius": f["bore_diameter_mm"] / 2,
            "boss_radius": f["boss_diameter_mm"] / 2,
            "diaphragm": f["diaphragm_thickness_mm"],
            "ring_radius": f["inner_diameter_mm"] / 2 + f["ring_thickness_mm"],
            "ring_z": [ring_end - f["ring_width_mm"], ring_end],
            "E": m["youngs_modulus_GPa"] * 1e3,
            "nu": m["poissons_ratio"],
        }
        return json.dumps(found)


CASES = (
    Case("hole-free", "Hole-free cup (a body of revolution)", 0),
    Case("six-holes", "Cup with six bolt holes", 6),
)
