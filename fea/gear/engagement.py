"""How long teeth hold: load presses them out of their spaces, and those that are out carry nothing.

A tooth's withdrawal is y = stroke − u_r of the rim + u_r of the circular spline. Beyond the working depth it
is out, the others take its load, and they are pressed out in turn. At the torque where none is left the
flexspline jumps to its next spaces. Elastic, without friction, and nothing but rim, race, balls, teeth and
circular spline yields: a real gear gives way before.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from flexspline.fea.gear.equilibrium import Equilibrium, EquilibriumError, equilibrium
from flexspline.fea.gear.model import GearModel
from flexspline.fea.types import NMM_PER_NM

WITHIN = 0.05
"""Of the torque at which no tooth is left."""
MOST_DOUBLINGS = 10
"""From rated torque, a thousandfold; gears of catalogue sizes lose their teeth after 5 to 8."""
OUT = 10.0
"""Strokes that a tooth which is out stands off: it meets nothing any more."""


@dataclass(frozen=True)
class Engagement:
    """The gear's contacts, less the teeth that are pressed out."""

    model: GearModel

    @cached_property
    def lift(self) -> np.ndarray:
        """(t, k) withdrawal of each tooth, mean over its face, per contact force [mm/N]."""
        model, rim = self.model, self.model.rim
        port, angle = model.pitch_points
        n, flanks = len(port) // 2, model.flanks
        of_seat = (
            np.tile(rim.on_seat, len(model.seat_angles)),
            np.repeat(model.seat_angles, len(rim.seat)),
        )
        ports, angles = np.concatenate([port, of_seat[0]]), np.concatenate([angle, of_seat[1]])
        moved = rim.body.compliance(ports, angles)[:n]
        per_force = np.zeros((n, model.balls.stop))
        per_force[:, flanks] = moved[:, : len(port)] @ model.gap_per_pitch_point.T
        per_force[:, model.seat] = moved[:, len(port) :]
        if model.spline:
            other = model.spline.compliance(port, angle)[:n]
            per_force[:, flanks] += other @ model.gap_per_pitch_point.T
        return -np.einsum(
            "tfk,f->tk", per_force.reshape(-1, len(rim.face), per_force.shape[1]), rim.face
        )

    def withdrawal(self, at: Equilibrium) -> np.ndarray:
        """(t,) y of each tooth under load [mm]."""
        return np.asarray(self.model.mesh.stroke + self.lift @ at.forces)

    def held(self, torque_Nm: float) -> Equilibrium | None:
        """With all teeth that the load leaves within the working depth; None: no tooth is left."""
        model, all_in = self.model, self.model.contacts
        stroke, depth = model.mesh.stroke, model.mesh.depth * model.mesh.stroke
        out = np.zeros(len(model.tooth_angles), bool)
        at: Equilibrium | None = None
        while not out.all():
            off = np.zeros_like(all_in.free)
            off[model.flanks] = OUT * stroke * np.tile(np.repeat(out, len(model.rim.face)), 2)
            try:
                at = equilibrium(
                    replace(all_in, free=all_in.free + off), torque_Nm * NMM_PER_NM / 2, at
                )
            except EquilibriumError:
                return None
            pressed = ~out & (self.withdrawal(at) > depth)
            if not pressed.any():
                return at
            out |= pressed
        return None

    def limit(self, first_Nm: float) -> float | None:
        """Torque [N·m] at which teeth let go, sought from a torque that they hold; None: far beyond it."""
        low = first_Nm
        for _ in range(MOST_DOUBLINGS):
            high = 2 * low
            if self.held(high) is None:
                break
            low = high
        else:
            return None
        while high - low > WITHIN * low:
            middle = (low + high) / 2
            low, high = (middle, high) if self.held(middle) else (low, middle)
        return (low + high) / 2
