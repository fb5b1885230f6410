"""Torque at which a cup's tube buckles: CalculiX on bricks beside `fea.gear.tube_buckling`.

python3 benchmarks/tube_buckling.py     some minutes; writes tube_buckling.json

The whole cup of examples/xb1-40.toml without holes and fillets, with other walls and lengths; its boss is
held, its ring rests on a rigid plug (no radial displacement) and takes the torque. Half a turn of it: what
stands half a turn away moves alike, so waves come in even numbers. Linear buckling: no imperfection.
"""

from __future__ import annotations

import json
import re
import subprocess
import tempfile
from pathlib import Path

from gear_contact import stiffness as stiff
from gear_contact.mesh import INSIDE, Part, cup

from flexspline.fea.gear.tube_buckling import Tube
from flexspline.fea.types import Elastic
from flexspline.geometry.design import Design
from flexspline.geometry.load import load_design

ROOT = Path(__file__).parents[1]
RESULTS = Path(__file__).with_suffix(".json")
BARE = {
    "flexspline.bolt_count": 0,
    "flexspline.inner_fillet_mm": 0.0,
    "flexspline.outer_fillet_mm": 0.0,
}
CASES: tuple[tuple[float, float], ...] = (
    (0.4, 30.0),
    (0.25, 30.0),
    (0.25, 22.0),
    (0.25, 45.0),
    (0.15, 30.0),
)
"""Wall and length of the cup [mm]."""
MESHES = ((50, 1), (80, 2))
"""Bricks in half a turn, bricks through the wall."""
LOAD_Nm = 100.0


def cup_of(wall: float, length: float) -> Design:
    """The example's cup with another tube, the diaphragm in proportion to the wall."""
    return load_design(ROOT / "examples" / "xb1-40.toml").changed(
        {
            **BARE,
            "flexspline.wall_thickness_mm": wall,
            "flexspline.diaphragm_thickness_mm": 1.5 * wall,
            "flexspline.length_mm": length,
        }
    )


def deck(design: Design, part: Part) -> str:
    """Boss held, ring on a rigid plug under LOAD_Nm, then the least factor of it that buckles the cup."""
    held = part.polar[:, 2] < 1e-6
    land = held & (part.polar[:, 0] <= design.flexspline.boss_diameter_mm / 2 + 1e-6)
    seat = sorted({n for _, _, face in part.faces["ring", INSIDE] for n in face})
    twins = stiff.twins(part)
    own = [n for n in seat if n not in twins]
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i},{x:.12g},{y:.12g},{z:.12g}" for i, (x, y, z) in enumerate(part.xyz, 1)]
    lines.append("*ELEMENT, TYPE=C3D20R, ELSET=PART")
    for i, cell in enumerate((part.cells + 1).tolist(), 1):
        lines += [f"{i}," + ",".join(map(str, cell[:10])) + ",", ",".join(map(str, cell[10:]))]
    steel = Elastic.of(design.material.flexspline)
    lines += [
        "*MATERIAL, NAME=M",
        "*ELASTIC",
        f"{steel.youngs_modulus_MPa},{steel.poissons_ratio}",
        "*SOLID SECTION, ELSET=PART, MATERIAL=M",
    ]
    # cylinder coordinates everywhere: alike half a turn away is equal
    lines += ["*TRANSFORM, NSET=ALL, TYPE=C", "0.,0.,0.,0.,0.,1."]
    lines.append("*NSET, NSET=LAND")
    lines += [f"{i + 1}," for i in range(len(land)) if land[i] and i not in twins]
    lines.append("*NSET, NSET=SEAT")
    lines += [f"{i + 1}," for i in own]
    for end, begin in twins.items():
        for direction in (1, 2, 3):
            lines += ["*EQUATION", "2", f"{end + 1},{direction},1.,{begin + 1},{direction},-1."]
    lines += ["*BOUNDARY", "LAND,1,3", "SEAT,1,1", "*STEP", "*BUCKLE", "4", "*CLOAD"]
    share = LOAD_Nm * 1000 / 2 / (len(own) * design.flexspline.inner_radius)
    lines += [f"SEAT,2,{share:.9g}", "*NODE FILE", "U", "*END STEP"]
    return "\n".join(lines) + "\n"


def factor(text: str) -> float:
    """The least positive buckling factor in CalculiX' .dat."""
    found = [float(m[1]) for m in re.finditer(r"^\s+\d+\s+(-?\d\.\d+E[+-]\d+)\s*$", text, re.M)]
    return min(f for f in found if f > 0)


def solved(design: Design, around: int, fine: int) -> float:
    """Torque of the first mode [N·m]."""
    part = Part(cup(design.flexspline, fine), around)
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "cup.inp").write_text(deck(design, part), encoding="utf-8")
        subprocess.run(["ccx", "-i", "cup"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        return LOAD_Nm * factor((Path(folder) / "cup.dat").read_text(encoding="utf-8"))


def main() -> None:
    """Each case on each mesh."""
    rows = []
    for wall, length in CASES:
        design = cup_of(wall, length)
        steel = design.material.flexspline
        tube = Tube.between(design.flexspline, Elastic.of(steel))
        row = {
            "wall_mm": wall,
            "length_mm": length,
            "hinged_Nm": tube.torque_Nm("hinged"),
            "clamped_Nm": tube.torque_Nm("clamped"),
            "calculix_Nm": [solved(design, *mesh) for mesh in MESHES],
        }
        print(row, flush=True)
        rows.append(row)
    version = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout.split()[-1]
    RESULTS.write_text(
        json.dumps({"calculix": version, "meshes": MESHES, "cups": rows}, indent=1) + "\n"
    )


if __name__ == "__main__":
    main()
