"""The gear as a series chain: teeth, rim and bearing in contact, then bolt holes and shaft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from flexspline.fea.gear.equilibrium import Equilibrium
from flexspline.fea.gear.model import GearModel
from flexspline.fea.threads import one_thread
from flexspline.fea.types import NMM_PER_NM
from flexspline.geometry.design import Design
from flexspline.geometry.part import Part
from flexspline.pipeline import revolved
from flexspline.pipeline.gear.gear_model import gear_model
from flexspline.pipeline.part_stiffness import part_stiffness
from flexspline.pipeline.parts import AnalysisContext


def chords(torques_Nm: Sequence[float] | np.ndarray, angles_rad: np.ndarray) -> tuple[float, ...]:
    """Return the stiffness [N·m/rad] between each torque and the next."""
    return tuple((np.diff(torques_Nm) / np.diff(angles_rad)).tolist())


@dataclass(frozen=True)
class Chain:
    """The contact model with what stands behind it in series.

    `shaft`, `holes`: compliance of the shaft, and what bolt holes add to the flexspline's [rad/(N·m)].
    """

    model: GearModel
    shaft: float
    holes: float

    def angle(self, at: Equilibrium) -> float:
        """Return the rotation of the output [rad]."""
        return at.rotation + self.torque_Nm(at) * (self.shaft + self.holes)

    @staticmethod
    def torque_Nm(at: Equilibrium) -> float:
        """Return the torque on the whole gear; an equilibrium's is that of one half [N·mm]."""
        return 2 * at.torque / NMM_PER_NM

    def along(
        self, torques_Nm: Sequence[float], start: Equilibrium | None = None
    ) -> list[Equilibrium]:
        """Solve one torque after the other, each from the one before; `start`: an equilibrium near the first.

        Raises
        ------
        EquilibriumError
        """
        states: list[Equilibrium] = []
        with one_thread():
            for torque in torques_Nm:
                states.append(self.model.at_torque(torque, states[-1] if states else start))
        return states

    def angles(self, torques_Nm: Sequence[float]) -> np.ndarray:
        """Return the output's rotations [rad]; errors as `along`."""
        return np.array([self.angle(at) for at in self.along(torques_Nm)])

    def shares(self, at: Equilibrium) -> dict[str, float]:
        """Return the shares of dθ/dT, in the order in which torque passes."""
        parts = {k: v * NMM_PER_NM for k, v in self.model.compliance_of(at).items()}
        parts["flexspline"] += self.holes
        parts["shaft"] = self.shaft
        total = sum(parts.values())
        return {key: parts[key] / total for key in ("flexspline", "shaft", "teeth", "bearing")}


def chain_of(context: AnalysisContext, K_e_Nm_per_rad: float | None = None) -> Chain:
    """Return a design's contact model, its shaft (of that stiffness, where it is known) and its bolt holes.

    Raises
    ------
    DesignError
    ComputationError
    """
    flexspline = context.part("flexspline")
    with context.progress.stage("flexspline, condensed to its teeth and its seat"):
        model = gear_model(context.design, flexspline.part)
    holes = _of_holes(flexspline.part, flexspline.tolerance)
    K_e = K_e_Nm_per_rad or part_stiffness(context.part("shaft")).K_Nm_per_rad
    return Chain(model, 1 / K_e, holes)


def fast_chain(design: Design, K_e_Nm_per_rad: float, relative_width: float) -> Chain:
    """Return the chain with a known shaft; `relative_width` is that of the K that tell what bolt holes do.

    Raises
    ------
    DesignError
    ComputationError
    """
    part = revolved.with_equivalent_ring(design).part("flexspline")
    return Chain(gear_model(design, part), 1 / K_e_Nm_per_rad, _of_holes(part, relative_width))


def _of_holes(part: Part, relative_width: float) -> float:
    """What bolt holes add [rad/(N·m)], by K_b of the case `uniform`: 1/K with them less 1/K without."""
    if part.bolts is None:
        return 0.0
    holed, filled = (
        revolved.torsion(body, relative_width).K_Nm_per_rad for body in (part, part.without_holes())
    )
    return max(0.0, 1 / holed - 1 / filled)
