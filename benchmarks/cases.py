"""The two cups and their load cases that everybody computes: design and STEP files, where patches are."""

from __future__ import annotations

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
CUP = ROOT / "examples" / "xb1-40.toml"
WEDGE_DEG, QUARTER_DEG = 30.0, 90.0
ACCURACIES_PCT = (1.0, 0.5, 0.1)
"""True errors to which every program is timed."""
LOADS = {
    "uniform": "",
    "lobes": "torque at the two lobes, seat held radially",
    "lobes_unsupported": "torque at the two lobes, rim unsupported",
    "ellipse": "peak stress on the wave generator's ellipse",
}
"""Of docs/contract.md, and their words in titles. Lift-off is left out: contact, which the peers' scripts
do not solve."""


@dataclass(frozen=True)
class Case:
    """A cup under a load; `holes` 0 makes it a body of revolution."""

    holes: int
    load: str = "uniform"

    @property
    def name(self) -> str:
        cup = "six-holes" if self.holes else "hole-free"
        return cup if self.load == "uniform" else f"{cup}, {self.load}"

    @property
    def title(self) -> str:
        cup = "Cup with six bolt holes" if self.holes else "Hole-free cup (a body of revolution)"
        return cup if self.load == "uniform" else f"{cup}, {LOADS[self.load]}"

    @property
    def figure(self) -> str:
        """What is compared: the key of a run's answer."""
        return "peak_MPa" if self.load == "ellipse" else "K"

    @property
    def unit(self) -> str:
        return "MPa" if self.load == "ellipse" else "N·m/rad"

    def design_text(self, tolerance_pct: float | None = None) -> str:
        text = CUP.read_text(encoding="utf-8")
        text = text.replace("bolt_count = 6", f"bolt_count = {self.holes}")
        return text + (f"\n[solver]\ntolerance_pct = {tolerance_pct}\n" if tolerance_pct else "")

    def design(self) -> Any:
        from flexspline.geometry.load import design_from

        return design_from(tomllib.loads(self.design_text()))

    def step(self, folder: Path, sector_deg: float) -> Path:
        """The STEP file of the whole flexspline or a wedge, written once."""
        path = folder / f"{self.holes}-holes-{sector_deg:g}.step"
        if not path.exists():
            from flexspline.geometry.cad import build_solid, write_step

            solid = build_solid(self.design().part("flexspline"), sector_deg)
            write_step(solid, path, "flexspline")
        return path

    def patches(self) -> str:
        """What a peer needs to find the patches among the STEP file's faces, as JSON (mm, MPa).

        `left_out`: within `left_out_mm` of these circles (r, z) stress is singular and counts for no peak.
        """
        data = tomllib.loads(self.design_text())
        f, m = data["flexspline"], data["material"]["flexspline"]
        ring_end = f["length_mm"] - f["ring_offset_mm"]
        design = self.design()
        part = design.part("flexspline")
        found: dict[str, Any] = {
            "holes": self.holes,
            "hole_radius": f["bolt_hole_diameter_mm"] / 2,
            "bore_radius": f["bore_diameter_mm"] / 2,
            "boss_radius": f["boss_diameter_mm"] / 2,
            "diaphragm": f["diaphragm_thickness_mm"],
            "seat_radius": f["inner_diameter_mm"] / 2,
            "wall_radius": f["inner_diameter_mm"] / 2 + f["wall_thickness_mm"],
            "ring_radius": f["inner_diameter_mm"] / 2 + f["ring_thickness_mm"],
            "ring_z": [ring_end - f["ring_width_mm"], ring_end],
            "E": m["youngs_modulus_GPa"] * 1e3,
            "nu": m["poissons_ratio"],
            "w0": design.w0_mm,
            "left_out": [*part.meridian.sharp_corners, *part.meridian.patch_edges],
            "left_out_mm": part.exclusion_mm,
        }
        return json.dumps(found)


CASES = tuple(Case(holes, load) for load in LOADS for holes in (0, 6))
