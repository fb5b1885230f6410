"""The gear as one contact problem: teeth on both flanks, the rim on its race, balls between race and plug.

Places that can touch, in this order: front flanks (tooth by tooth, place by place along the face), back
flanks, seat (angle by angle, place by place), balls. All stand twice, at φ and φ + π; forces are those of one
of the two, so half the torque is theirs.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, pi, sin

import numpy as np

from flexspline.fea.gear.condensed import Condensed
from flexspline.fea.gear.equilibrium import Contacts, Equilibrium, equilibrium
from flexspline.fea.gear.kinematics import ToothMesh
from flexspline.fea.gear.plug import Plug
from flexspline.fea.gear.rim import Rim
from flexspline.fea.types import NMM_PER_NM


@dataclass(frozen=True)
class GearModel:
    """All that the equilibrium needs.

    Attributes
    ----------
    race : the outer race; None: the rim rests on the rigid plug itself.
    spline : the circular spline's rim, port by port as the rim's pitch point; None: rigid.
    pair : compliance of one pair of teeth over its whole face [mm/N].
    teeth : z1; `most_stations` stand for them at most.
    """

    mesh: ToothMesh
    wave_generator: Plug
    rim: Rim
    race: Condensed | None
    spline: Condensed | None
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

    @cached_property
    def seat_angles(self) -> np.ndarray:
        """As many as harmonics can tell apart [rad]."""
        return np.arange(self.rim.body.last) * pi / self.rim.body.last

    @cached_property
    def flanks(self) -> slice:
        """Of the contacts: front flanks, then back flanks."""
        return slice(0, 2 * len(self.tooth_angles) * len(self.rim.face))

    @cached_property
    def seat(self) -> slice:
        """Of the contacts."""
        first = self.flanks.stop
        return slice(first, first + len(self.seat_angles) * len(self.rim.seat))

    @cached_property
    def balls(self) -> slice:
        """Of the contacts; empty without a race."""
        count = len(self.wave_generator.angles) if self.race else 0
        return slice(self.seat.stop, self.seat.stop + count)

    @cached_property
    def shares(self) -> dict[str, np.ndarray]:
        """(k, k) gap per force [mm/N] of flexspline, teeth with the circular spline, and race."""
        k = self.balls.stop
        bearing = self._of_race(self.race) if self.race else np.zeros((k, k))
        return {"flexspline": self._of_rim(), "teeth": self._of_teeth(), "bearing": bearing}

    @cached_property
    def contacts(self) -> Contacts:
        wave, k = self.wave_generator, self.balls.stop
        free, turning, hertz = np.zeros(k), np.zeros(k), np.zeros(k)
        free[self.flanks] = self._flank_gaps().ravel()
        arm = self.mesh.pitch_radius * cos(self.mesh.pressure_angle)
        turning[self.flanks] = np.repeat([-arm, arm], self.flanks.stop // 2)
        if self.race:
            free[self.balls] = wave.gap(wave.angles)
            hertz[self.balls] = wave.hertz
        else:
            free[self.seat] = np.repeat(wave.gap(self.seat_angles), len(self.rim.seat))
        return Contacts(free, sum(self.shares.values(), np.zeros((k, k))), turning, hertz)

    def _flank_gaps(self) -> np.ndarray:
        """Front, then back (2, t, f) [mm], with the rim undeformed."""
        phi = self.tooth_angles
        still = np.zeros_like(phi)
        gaps = np.array(self.mesh.gaps(phi, still, still)) + self.mesh.relief(phi)
        cone = np.zeros((2, len(phi), len(self.rim.face)))
        if self.mesh.face == "relieved":
            cone[:] = self.mesh.closing(phi[:, None], *self.rim.cone(self.mesh.stroke))
        return gaps[..., None] + cone

    def compliance_of(self, at: Equilibrium) -> dict[str, float]:
        """Parts of dθ/dT [rad/(N·mm)] at an equilibrium, while the same places stay in contact; they add up.

        By the energy of a small further load: dT dθ = Σ dF·C dF over flexspline, teeth and bearing.
        """
        change = at.forces_slope / 2  # each half takes half the torque
        parts = {part: 2 * float(change @ C @ change) for part, C in self.shares.items()}
        ball, force = change[self.balls], at.forces[self.balls]
        on = at.loaded[self.balls]
        yields = 2 / 3 * self.wave_generator.hertz * force[on] ** (-1 / 3)
        parts["bearing"] += 2 * float(ball[on] ** 2 @ yields)
        return parts

    def with_gaps(self, mesh: ToothMesh, wave_generator: Plug) -> GearModel:
        """The same bodies with another clearance, play or stroke: how they yield is not found again."""
        other = replace(self, mesh=mesh, wave_generator=wave_generator)
        other.__dict__["shares"] = self.shares
        return other

    def at_torque(self, torque_Nm: float, start: Equilibrium | None = None) -> Equilibrium:
        """At a torque on the whole gear [N·m]; `Equilibrium.torque` is that of one half [N·mm].

        Raises
        ------
        EquilibriumError
        """
        return equilibrium(self.contacts, torque_Nm * NMM_PER_NM / 2, start)

    def like(self, other: Equilibrium) -> Equilibrium:
        """At the torque of an equilibrium of a gear that differs by its gaps only; errors as `at_torque`."""
        return equilibrium(self.contacts, other.torque, other)

    def flank_forces(self, at: Equilibrium) -> np.ndarray:
        """Of one tooth's front and back flank at each of `tooth_angles` (2, t) [N]."""
        forces = at.forces[self.flanks].reshape(2, len(self.tooth_angles), -1).sum(axis=2)
        return np.asarray(forces / self.teeth_per_station)

    def pair_forces(self, at: Equilibrium) -> np.ndarray:
        """Of a pair of teeth at each of `tooth_angles` (t,) [N]: front flank less back flank."""
        front, back = self.flank_forces(at)
        return np.asarray(front - back)

    @cached_property
    def rim_compliance(self) -> np.ndarray:
        """Displacement per force [mm/N] of the flexspline at `pitch_points`, then at the seat."""
        a, m = len(self.seat_angles), len(self.rim.seat)
        port = np.concatenate([self.pitch_points[0], np.tile(self.rim.on_seat, a)])
        angle = np.concatenate([self.pitch_points[1], np.repeat(self.seat_angles, m)])
        return self.rim.body.compliance(port, angle)

    def _of_rim(self) -> np.ndarray:
        flanks, moved = self.flanks.stop, self.rim_compliance
        half = np.concatenate([self.at_flanks(moved[:flanks]), moved[flanks:]]).T
        compliance = np.zeros((self.balls.stop, self.balls.stop))
        seat = len(moved)
        compliance[:seat, :seat] = np.concatenate([self.at_flanks(half[:flanks]), half[flanks:]])
        return compliance

    def _of_teeth(self) -> np.ndarray:
        k, flanks = self.balls.stop, self.flanks.stop
        compliance = np.zeros((k, k))
        i = np.arange(flanks)
        face = np.tile(self.rim.face, 2 * len(self.tooth_angles))
        compliance[i, i] = self.pair / self.teeth_per_station / face
        if self.spline:
            half = self.at_flanks(self.spline.compliance(*self.pitch_points)).T
            compliance[:flanks, :flanks] += self.at_flanks(half)
        return compliance

    def at_flanks(self, moved: np.ndarray) -> np.ndarray:
        """Gaps (k, j) of the flanks where `pitch_points` move by (k, j); the spline's count the other way."""
        s, c = sin(self.mesh.pressure_angle), cos(self.mesh.pressure_angle)
        radial, tangential = np.split(moved, 2)
        return np.concatenate([-s * radial - c * tangential, c * tangential - s * radial])

    @cached_property
    def pitch_points(self) -> tuple[np.ndarray, np.ndarray]:
        """Ports and angles [rad]: radial tooth by tooth, place by place, then tangential."""
        rim, t = self.rim, len(self.tooth_angles)
        port = np.concatenate([np.tile(rim.radial, t), np.tile(rim.tangential, t)])
        return port, np.tile(np.repeat(self.tooth_angles, len(rim.face)), 2)

    def _of_race(self, race: Condensed) -> np.ndarray:
        a, m, at = len(self.seat_angles), len(self.rim.seat), self.wave_generator.angles
        port = np.concatenate([np.tile(np.arange(m), a), np.full(len(at), m)])
        angle = np.concatenate([np.repeat(self.seat_angles, m), at])
        sign = np.concatenate([-np.ones(a * m), np.ones(len(at))])
        compliance = np.zeros((self.balls.stop, self.balls.stop))
        compliance[self.seat.start :, self.seat.start :] = (
            sign[:, None] * sign * race.compliance(port, angle)
        )
        return compliance
