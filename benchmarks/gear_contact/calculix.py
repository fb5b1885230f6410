"""Surface contact by CalculiX itself: the rim on the rigid plug under the tooth forces of solve.py.

    python3 -m benchmarks.gear_contact.calculix              small displacements, about ten minutes
    python3 -m benchmarks.gear_contact.calculix NLGEOM       large ones

Rim and plug are two meshes with *CONTACT PAIR, TYPE=SURFACE TO SURFACE between them. The plug takes its
ellipse, then teeth push with the forces that the least squares found at each turn, while the mount stands
still. Each tooth that carries then says by how much the output has turned: what closes its gap, less its own
compliance. Their mean, weighted with the forces, is compared with the turn that was prescribed there. With
springs for teeth in the deck CalculiX' Newton steps do not settle, nor with the race between rim and balls.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from math import cos, sin
from pathlib import Path

import numpy as np

from flexspline.fea.gear.model import GearModel
from flexspline.fea.types import Elastic
from flexspline.pipeline.gear.gear_model import gear_model

from . import solve as gear
from . import stiffness as stiff
from .mesh import INSIDE, OUTSIDE, Part, cup, hoop

PRESSURE = 1e5
"""Per penetration [MPa/mm]: 1 µm at the seat's inner edge, by which every turn is some 0.02 mrad larger."""
PLUG_MM = 1.0
"""Thickness of the plug's skin; all its nodes are prescribed."""


class Deck:
    """Rim, plug and teeth; node numbers of the plug follow the rim's, the teeth's follow the plug's."""

    def __init__(self, model: GearModel, mesh: gear.Mesh):
        self.of, self.model = gear.design(), model
        f = self.of.flexspline
        self.rim = Part(cup(f, mesh.fine), mesh.around)
        self.plug = Part(hoop(f, PLUG_MM, mesh.fine), mesh.around)
        slices = gear.tooth_functionals(self.of, model, self.rim)
        self.flanks = [
            stiff.total(slices[i : i + gear.SLICES]) for i in range(0, len(slices), gear.SLICES)
        ]
        self.first_plug = len(self.rim.xyz) + 1
        self.first_tooth = self.first_plug + len(self.plug.xyz)

    def parts(self) -> list[str]:
        places = np.vstack([self.rim.xyz, self.plug.xyz, np.zeros((len(self.flanks), 3))])
        lines = ["*NODE, NSET=ALL"]
        lines += [f"{i},{x:.12g},{y:.12g},{z:.12g}" for i, (x, y, z) in enumerate(places, 1)]
        element = 1
        for name, part, first in (("RIM", self.rim, 1), ("PLUG", self.plug, self.first_plug)):
            lines.append(f"*ELEMENT, TYPE=C3D20R, ELSET={name}")
            for cell in (part.cells + first).tolist():
                lines += [f"{element}," + ",".join(map(str, cell[:10])) + ","]
                lines += [",".join(map(str, cell[10:]))]
                element += 1
        steel = Elastic.of(self.of.material.flexspline)
        lines += ["*MATERIAL, NAME=M", "*ELASTIC"]
        lines += [f"{steel.youngs_modulus_MPa},{steel.poissons_ratio}"]
        lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL=M" for name in ("RIM", "PLUG")]
        return lines

    def contact(self) -> list[str]:
        lines = ["*SURFACE, NAME=SEAT, TYPE=ELEMENT"]
        lines += [f"{e + 1},{side}" for e, side, _ in self.rim.faces["ring", INSIDE]]
        lines.append("*SURFACE, NAME=ELLIPSE, TYPE=ELEMENT")
        past = len(self.rim.cells) + 1
        lines += [f"{e + past},{side}" for e, side, _ in self.plug.faces["hoop", OUTSIDE]]
        lines += ["*SURFACE INTERACTION, NAME=TOUCH"]
        lines += ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{PRESSURE:g}"]
        lines += ["*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "SEAT,ELLIPSE"]
        return lines

    def couplings(self, held: set[int]) -> list[str]:
        """Ends alike after half a turn; a node of each flank that moves as its slices do together."""
        lines = []
        for end, begin in stiff.twins(self.rim).items():
            for d, sign in ((1, 1), (2, 1), (3, -1)):
                if end not in held:
                    lines += ["*EQUATION", "2", f"{end + 1},{d},1.,{begin + 1},{d},{sign}."]
        for i, flank in enumerate(self.flanks):
            words = [f"{self.first_tooth + i},1,-1."]
            for node, shares in flank.items():
                words += [
                    f"{node + 1},{d},{share / gear.SLICES:.12g}"
                    for d, share in enumerate(shares, 1)
                ]
            lines += ["*EQUATION", str(len(words))]
            lines += [",".join(words[j : j + 4]) for j in range(0, len(words), 4)]
        return lines

    def ellipse(self) -> list[str]:
        """The plug's nodes go with a rim that does not stretch: little is left to slide."""
        wave, lines = self.model.wave_generator, []
        for i, phi in enumerate(self.plug.polar[:, 1].tolist(), self.first_plug):
            out = wave.deflection * cos(2 * phi) - wave.play / 2
            on = -wave.deflection * sin(2 * phi) / 2
            x, y = out * cos(phi) - on * sin(phi), out * sin(phi) + on * cos(phi)
            lines += [f"{i},1,1,{x:.10g}", f"{i},2,2,{y:.10g}", f"{i},3,3"]
        return lines

    def text(self, loads: list[np.ndarray], large: str) -> str:
        boss = self.of.flexspline.boss_diameter_mm / 2 + 1e-6
        held = np.flatnonzero((self.rim.polar[:, 2] == 0) & (self.rim.polar[:, 0] < boss)).tolist()
        lines = self.parts() + self.contact() + self.couplings(set(held))
        lines += ["*BOUNDARY", *(f"{n + 1},1,3" for n in held)]
        teeth = range(self.first_tooth, self.first_tooth + len(self.flanks))
        lines += [f"{n},2,3" for n in teeth]
        lines += ["*NSET, NSET=TEETH", *(f"{n}," for n in teeth)]
        for i, push in enumerate([np.zeros(len(self.flanks)), *loads]):
            lines += [f"*STEP, INC=100{large}", "*STATIC", "0.25,1." if i == 0 else "0.5,1."]
            lines += ["*CONTROLS, PARAMETERS=FIELD, FIELD=DISPLACEMENT", "1e-4,1e-2"]
            lines += ["*BOUNDARY", *self.ellipse()] if i == 0 else []
            lines += ["*CLOAD", *(f"{n},1,{-f:.9g}" for n, f in zip(teeth, push, strict=True))]
            lines += ["*NODE PRINT, NSET=TEETH, FREQUENCY=1000", "U", "*END STEP"]
        return "\n".join(lines) + "\n"


def closed(folder: Path, first: int, count: int) -> list[np.ndarray]:
    """How far each flank's gap has closed [mm], at the end of every step."""
    found: dict[float, np.ndarray] = {}
    for line in (folder / "gear.dat").read_text(encoding="utf-8").splitlines():
        words = line.split()
        if "displacements" in words:
            now = found.setdefault(float(words[-1]), np.zeros(count))
        elif words and words[0].isdigit():
            now[int(words[0]) - first] = float(words[1])
    return [moved for when, moved in found.items() if abs(when - round(when)) < 1e-9]


def main() -> None:
    large = ", NLGEOM" if "NLGEOM" in sys.argv[1:] else ""
    of, mesh = gear.design(), gear.MESHES["coarse"]
    model = gear_model(of, of.part("flexspline"))
    deck = Deck(model, mesh)
    with tempfile.TemporaryDirectory() as name:
        rim = gear.rim_of(of, model, mesh, Path(name, "rim"))
    problem = gear.problem(of, model, rim, None, 1)
    loads = [problem.forces(turn)[: problem.flanks] for turn in gear.TURNS["plug"]]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "gear.inp").write_text(deck.text(loads, large), encoding="utf-8")
        with (folder / "log").open("w", encoding="utf-8") as log:
            subprocess.run(["ccx", "-i", "gear"], cwd=folder, env=os.environ | {"OMP_NUM_THREADS": "1"},
                           stdout=log)  # fmt: skip
        states = closed(folder, deck.first_tooth, len(deck.flanks))
    gap, found = problem.gap[: problem.flanks], []
    turning = problem.turning[: problem.flanks]
    for push, moved, turn in zip(loads, states[1:], gear.TURNS["plug"], strict=True):
        # 0 = gap − moved + pair F + c θ on each flank that carries
        own = (gap - moved + model.pair * push) / -turning
        on = push > 0
        mean = float(push @ own / push.sum())
        found.append({
            "turn_rad": turn, "torque_Nm": float(-2 * turning @ push / 1e3), "own_turn_rad": mean,
            "spread_rad": float(np.ptp(own[on])),
        })  # fmt: skip
        print(found[-1], flush=True)
    record = json.loads(gear.RESULTS.read_text(encoding="utf-8"))
    record["surface contact" + large.lower()] = found
    gear.RESULTS.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
