"""The gear as one contact problem: teeth on both flanks, the rim on its race, balls between race and plug.

Places that can touch, in this order: front flanks, back flanks, seat (angle by angle, place by place), balls.
All stand twice, at φ and φ + π; forces are those of one of the two, so half the torque is theirs.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sin

import numpy as np

from flexspline.fea.gear.condensed import Condensed
from flexspline.fea.gear.equilibrium import Contacts, Equilibrium, equilibrium
from flexspline.fea.gear.kinematics import Mesh
from flexspline.fea.gear.rim import FIRST_PLACE, TOOTH_RADIAL, TOOTH_TANGENTIAL
from flexspline.fea.types import NMM_PER_NM


@dataclass(frozen=True)
class WaveGenerator:
    """A rigid plug, w0 cos 2φ larger than a circle, and its balls.

    Attributes
    ----------
    deflection : w0 [mm].
    play : c [mm]: each ball has half of it.
    balls : how many, even.
    hertz : C of each ball [mm/N^(2/3)].
    """

    deflection: float
    play: float
    balls: int
    hertz: float

    @property
    def angles(self) -> np.ndarray:
        """Of the balls over half a turn [rad], one on the major axis."""
        return 2 * pi / self.balls * np.arange(self.balls // 2)


@dataclass(frozen=True)
class GearModel:
    """All that the equilibrium needs.

    Attributes
    ----------
    race : the outer race; None: the rim rests on the rigid plug itself.
    pair : compliance of one pair of teeth [mm/N].
    teeth : z1; `most_stations` stand for them at most.
    """

    mesh: Mesh
    wave_generator: WaveGenerator
    rim: Condensed
    race: Condensed | None
    pair: float
    teeth: int
    most_stations: int

    @cached_property
    def tooth_angles(self) -> np.ndarray:
        """φ of the teeth within reach [rad]."""
        return self.mesh.stations(self.teeth, self.most_stations)[0]

    @property
    def teeth_per_station(self) -> float:
        return self.mesh.stations(self.teeth, self.most_stations)[1]

    @property
    def places(self) -> int:
        """Along the seat."""
        return len(self.rim.tangential) - FIRST_PLACE

    @cached_property
    def seat_angles(self) -> np.ndarray:
        """As many as harmonics can tell apart [rad]."""
        return np.arange(self.rim.last) * pi / self.rim.last

    @cached_property
    def flanks(self) -> slice:
        """Of the contacts: front flanks, then back flanks."""
        return slice(0, 2 * len(self.tooth_angles))

    @cached_property
    def seat(self) -> slice:
        """Of the contacts."""
        first = self.flanks.stop
        return slice(first, first + len(self.seat_angles) * self.places)

    @cached_property
    def balls(self) -> slice:
        """Of the contacts; empty without a race."""
        count = len(self.wave_generator.angles) if self.race else 0
        return slice(self.seat.stop, self.seat.stop + count)

    @cached_property
    def shares(self) -> dict[str, np.ndarray]:
        """(k, k) gap per force [mm/N] of flexspline, teeth and race."""
        k = self.balls.stop
        found = {
            "flexspline": self._of_rim(),
            "teeth": np.zeros((k, k)),
            "bearing": np.zeros((k, k)),
        }
        flanks = np.arange(k)[self.flanks]
        found["teeth"][flanks, flanks] = self.pair / self.teeth_per_station
        if self.race:
            found["bearing"] = self._of_race(self.race)
        return found

    @cached_property
    def contacts(self) -> Contacts:
        phi, wave = self.tooth_angles, self.wave_generator
        still = np.zeros_like(phi)
        plain, relief = self.mesh.gaps(phi, still, still), self.mesh.relief(phi)
        k = self.balls.stop
        free, turning, hertz = np.zeros(k), np.zeros(k), np.zeros(k)
        free[self.flanks] = np.concatenate(plain) + np.concatenate(relief)
        arm = self.mesh.pitch_radius * cos(self.mesh.pressure_angle)
        turning[: len(phi)], turning[len(phi) : self.flanks.stop] = -arm, arm
        if self.race:
            free[self.balls] = wave.play / 2 - wave.deflection * np.cos(2 * wave.angles)
            hertz[self.balls] = wave.hertz
        else:
            plug = wave.play / 2 - wave.deflection * np.cos(2 * self.seat_angles)
            free[self.seat] = np.repeat(plug, self.places)
        return Contacts(free, sum(self.shares.values(), np.zeros((k, k))), turning, hertz)

    def compliance_of(self, at: Equilibrium) -> dict[str, float]:
        """Parts of dθ/dT [rad/(N·mm)] at an equilibrium, while the same places stay in contact; they add up.

        By the energy of a small further load: dT dθ = Σ dF·C dF over flexspline, teeth and bearing.
        """
        change = at.forces_slope / 2  # each half takes half the torque
        found = {part: 2 * float(change @ C @ change) for part, C in self.shares.items()}
        ball, force = change[self.balls], at.forces[self.balls]
        on = at.loaded[self.balls]
        yields = 2 / 3 * self.wave_generator.hertz * force[on] ** (-1 / 3)
        found["bearing"] += 2 * float(ball[on] ** 2 @ yields)
        return found

    def at_torque(self, torque_Nm: float, start: np.ndarray | None = None) -> Equilibrium:
        """At a torque on the whole gear [N·m]; `Equilibrium.torque` is that of one half [N·mm].

        Raises
        ------
        EquilibriumError
        """
        return equilibrium(self.contacts, torque_Nm * NMM_PER_NM / 2, start)

    def pair_forces(self, at: Equilibrium) -> np.ndarray:
        """Of a pair of teeth at each of `tooth_angles` (t,) [N]: front flank less back flank."""
        front, back = np.split(at.forces[self.flanks], 2)
        return (front - back) / self.teeth_per_station

    def _of_rim(self) -> np.ndarray:
        phi, a, m = self.tooth_angles, len(self.seat_angles), self.places
        t = len(phi)
        port = np.concatenate(
            [
                np.full(t, TOOTH_RADIAL),
                np.full(t, TOOTH_TANGENTIAL),
                np.tile(FIRST_PLACE + np.arange(m), a),
            ]
        )
        angle = np.concatenate([phi, phi, np.repeat(self.seat_angles, m)])
        s, c = sin(self.mesh.pressure_angle), cos(self.mesh.pressure_angle)
        gap = np.zeros((self.balls.stop, len(port)))  # per displacement
        i = np.arange(t)
        gap[i, i], gap[i, t + i] = -s, -c
        gap[t + i, i], gap[t + i, t + i] = -s, c
        j = np.arange(a * m)
        gap[2 * t + j, 2 * t + j] = 1
        return gap @ self.rim.compliance(port, angle) @ gap.T

    def _of_race(self, race: Condensed) -> np.ndarray:
        a, m, at = len(self.seat_angles), self.places, self.wave_generator.angles
        port = np.concatenate([np.tile(np.arange(m), a), np.full(len(at), m)])
        angle = np.concatenate([np.repeat(self.seat_angles, m), at])
        sign = np.concatenate([-np.ones(a * m), np.ones(len(at))])
        found = np.zeros((self.balls.stop, self.balls.stop))
        found[self.seat.start :, self.seat.start :] = (
            sign[:, None] * sign * race.compliance(port, angle)
        )
        return found
