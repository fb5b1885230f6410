"""Limit of tooth engagement: load presses teeth out of their spaces, and these teeth carry nothing.

A tooth's withdrawal is y = stroke − u_r of the rim + u_r of the circular spline. Beyond the working depth it
is out, the others take its load, and they are pressed out in turn. At the torque where none is left the
flexspline jumps to its next spaces. So it does where a tooth is bent by half its thickness, or pressed
beyond the root circle of its space: a soft circular spline ends so, and small displacements would let
teeth pass through each other. Teeth are loaded evenly along their faces: place by place the torque
moves by less than TORQUE_SHARE. Elastic, without friction, and nothing but rim, race, balls, teeth and
circular spline yields: a real gear ratchets earlier.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import pi, sqrt

import numpy as np
from scipy.linalg import block_diag

from flexspline.fea.gear.equilibrium import Contacts, Equilibrium, EquilibriumError, equilibrium
from flexspline.fea.gear.model import GearModel
from flexspline.fea.types import NMM_PER_NM
from flexspline.geometry.basic_rack import ADDENDUM, DEDENDUM

TORQUE_SHARE = 0.05
"""Of the torque at which no tooth is left."""
MOST_DOUBLINGS = 14
"""Most doublings or halvings of the torque at which the search begins: a factor of 16 000 either way."""
BENT_MODULES = pi / 4
"""[modules] Half the thickness of a tooth at the pitch circle."""
THROUGH = ADDENDUM + DEDENDUM
"""[modules] The height of a tooth. A tooth pressed deeper than this beyond full depth has crossed another."""
STAND_OFF_STROKES = 10.0
"""[strokes] Gap given to a tooth that is out of engagement, so that it meets nothing."""


@dataclass(frozen=True)
class Held:
    """An equilibrium, and which teeth are out (t,)."""

    at: Equilibrium
    out: np.ndarray


@dataclass(frozen=True)
class Engagement:
    """The gear's contacts, less the teeth that are pressed out."""

    model: GearModel

    @cached_property
    def evenly(self) -> np.ndarray:
        """(e, k): contacts with one for each flank, whose gap is the mean over its face."""
        model, face = self.model, self.model.rim.face
        flanks = np.kron(np.eye(2 * len(model.tooth_angles)), face)
        return block_diag(flanks, np.eye(model.balls.stop - model.flanks.stop))

    @cached_property
    def contacts(self) -> Contacts:
        """Of flanks, front, then back, then seat and balls."""
        single, mean = self.model.contacts, self.evenly
        few = len(mean) - len(single.free) + self.model.flanks.stop
        hertz = np.concatenate([np.zeros(few), single.hertz[self.model.flanks.stop :]])
        return Contacts(
            mean @ single.free, mean @ single.compliance @ mean.T, mean @ single.turning, hertz
        )

    @cached_property
    def lift(self) -> np.ndarray:
        """(t, e) withdrawal of each tooth, mean over its face, per contact force [mm/N]."""
        model, rim = self.model, self.model.rim
        port, angle = model.pitch_points
        n, flanks = len(port) // 2, model.flanks
        moved = model.rim_compliance[:n]
        per_force = np.zeros((n, model.balls.stop))
        per_force[:, flanks] = model.at_flanks(moved[:, : len(port)].T).T
        per_force[:, model.seat] = moved[:, len(port) :]
        if model.spline:
            other = model.spline.compliance(port, angle)[:n]
            per_force[:, flanks] += model.at_flanks(other.T).T
        mean = np.kron(np.eye(len(model.tooth_angles)), rim.face)
        return -mean @ per_force @ self.evenly.T

    def withdrawal(self, at: Equilibrium) -> np.ndarray:
        """(t,) y of each tooth under load [mm]."""
        return np.asarray(self.model.mesh.stroke + self.lift @ at.forces)

    def crossed(self, at: Equilibrium) -> bool:
        """Whether a tooth is bent or pressed so far that it has left its space through another."""
        model = self.model
        module = 2 * model.mesh.pitch_radius / model.teeth
        pressed = at.forces[: 2 * len(model.tooth_angles)].max() / model.teeth_per_station
        deepest = float(self.withdrawal(at).min())
        return bool(model.pair * pressed > BENT_MODULES * module or deepest < -THROUGH * module)

    def held(self, torque_Nm: float, before: Held | None = None) -> Held | None:
        """With all teeth that the load leaves within the working depth; None: no tooth is left.

        `before`: at a smaller torque on the way; teeth that were out there stay out.
        """
        model, all_in = self.model, self.contacts
        stroke, depth = model.mesh.stroke, model.mesh.depth * model.mesh.stroke
        out = before.out if before else np.zeros(len(model.tooth_angles), bool)
        at = before.at if before else None
        while not out.all():
            off = np.zeros_like(all_in.free)
            off[: 2 * len(out)] = STAND_OFF_STROKES * stroke * np.tile(out, 2)
            contacts = replace(all_in, free=all_in.free + off)
            try:
                at = equilibrium(contacts, torque_Nm * NMM_PER_NM / 2, at)
            except EquilibriumError:
                return None
            if self.crossed(at):
                return None
            pressed = ~out & (self.withdrawal(at) > depth)
            if not pressed.any():
                return Held(at, out)
            out = out | pressed
        return None

    def limit(self, first_Nm: float) -> float | None:
        """Ratcheting torque [N·m], sought both ways from a torque; None: far beyond it."""
        low, holds = first_Nm, self.held(first_Nm)
        for _ in range(MOST_DOUBLINGS):
            if holds:
                break
            low /= 2
            holds = self.held(low)
        if holds is None:
            return None
        high = low
        for _ in range(MOST_DOUBLINGS):
            high = 2 * low
            state = self.held(high, holds)
            if state is None:
                break
            low, holds = high, state
        else:
            return None
        while high > (1 + TORQUE_SHARE) * low:
            middle = sqrt(low * high)
            state = self.held(middle, holds)
            if state:
                low, holds = middle, state
            else:
                high = middle
        return sqrt(low * high)
