"""Radial compliance of the rim under forces on its seat, one matrix per harmonic.

Forces stand at equally spaced angles over half a turn (everything has period π, so only even harmonics
occur) and at places along the seat. Over the angles the compliance is block circulant: the Fourier transform
makes it one small matrix for each harmonic.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from flexspline.fea.axisymmetric.harmonics import Fixed, Harmonic, HarmonicModel
from flexspline.fea.axisymmetric.lobes import lobe_coefficient, lobe_harmonic, lobe_traction
from flexspline.fea.cylindrical import RADIAL, TANGENTIAL
from flexspline.fea.lobe_torque import stiffness_of_work


@dataclass(frozen=True)
class SeatCompliance:
    """The rim under forces at `angles` (a,) over half a turn and m places along the seat.

    Attributes
    ----------
    free : (a, m) radial displacement [mm] under LOBE_TORQUE_NMM at the lobes with nothing on the seat.
    harmonics : (a/2 + 1, m, m) radial displacement per force of harmonics 0, 2, … a [mm per N/rad].
    free_work : torque times rotation with nothing on the seat [N·mm].
    unknowns : of one harmonic.
    """

    angles: np.ndarray
    free: np.ndarray
    harmonics: np.ndarray
    free_work: float
    unknowns: int

    @property
    def matrix(self) -> np.ndarray:
        """Radial displacement per force (a·m, a·m), place by place within each angle [mm per N/rad]."""
        a, m = self.free.shape
        blocks = np.fft.irfft(self.harmonics, a, axis=0)  # by difference of angle
        i, j = np.meshgrid(np.arange(a), np.arange(a), indexing="ij")
        return blocks[(i - j) % a].transpose(0, 2, 1, 3).reshape(a * m, a * m)

    def resisted(self, displacement: np.ndarray) -> np.ndarray:
        """Return the forces (a, m) [N/rad] that alone displace the seat radially by (a, m) [mm]."""
        waves = np.fft.rfft(displacement, axis=0)
        parts = np.linalg.solve(self.harmonics, np.stack([waves.real, waves.imag], axis=2))
        return np.fft.irfft(parts[..., 0] + 1j * parts[..., 1], len(displacement), axis=0)

    def stiffness(self, force: np.ndarray) -> float:
        """Return K [N·m/rad] with seat forces (a, m) [N/rad], whose work is by Betti's theorem."""
        work = self.free_work + 2 * pi / len(self.angles) * float((force * self.free).sum())
        return stiffness_of_work(work)


def seat_compliance(model: HarmonicModel, angles: int, most_places: int) -> SeatCompliance:
    """Condense the harmonics 0, 2, … `angles` (an even number) to places along the seat.

    Each node of the seat is a place; where there are more than `most_places`, some of them are, and the
    force on one is spread over the nodes up to the next.
    """
    if angles % 2:
        raise ValueError("the number of angles must be even")
    seat = model.on("seat")
    spread = _spread(model, seat, most_places)
    phi = np.arange(angles) * pi / angles
    peak = lobe_traction(model)
    push = np.zeros((3 * model.space.count, spread.shape[1]))
    push[3 * seat + RADIAL] = spread
    free = np.zeros((angles, spread.shape[1]))
    harmonics = []
    work = 0.0
    for n in range(0, angles + 1, 2):
        # a force of 1 N/rad times cos nφ has the nodal amplitude ∫cos² nφ dφ
        wave = lobe_harmonic(n)
        twist = (peak * lobe_coefficient(n) * model.pressed("mesh", TANGENTIAL, wave))[:, None]
        if n:
            both = responses(model, wave, np.column_stack([push, twist]))
            pushed, u = both[:, :-1], both[:, -1]
        else:
            pushed, u = responses(model, Harmonic(0), push), responses(model, wave, twist)[:, 0]
        radial = Harmonic(n).around * spread.T @ pushed[3 * seat + RADIAL]
        harmonics.append((radial + radial.T) / 2)
        work += float(u @ twist[:, 0])
        # the load varies as cos nφ, so u_r as −sin nφ (the twin symmetry of `harmonics`)
        free -= np.sin(n * phi)[:, None] * (spread.T @ u[3 * seat + RADIAL])
    return SeatCompliance(phi, free, np.stack(harmonics), work, len(push))


def _spread(model: HarmonicModel, seat: np.ndarray, most: int) -> np.ndarray:
    """Nodal forces (s, m) of a unit force at each place, whose displacement is their mean in turn.

    Places are closer to each other towards the seat's edges, where the rim presses more. Between two places
    the pressure is linear.
    """
    if len(seat) <= most:
        return np.eye(len(seat))
    along = model.space.places[seat, 1]
    share = (1 - np.cos(np.linspace(0, pi, most))) / 2
    at = np.sort(along)[np.unique(((len(seat) - 1) * share).round().astype(int))]
    hats = np.stack([np.interp(along, at, one) for one in np.eye(len(at))], axis=1)
    hats *= model.pressed("seat", RADIAL, Harmonic(0))[3 * seat + RADIAL][:, None]
    return hats / hats.sum(axis=0)


def responses(
    model: HarmonicModel, wave: Harmonic, loads: np.ndarray, also: list[Fixed] | None = None
) -> np.ndarray:
    """Return displacements (3·count, k) under nodal forces (3·count, k); `mount` and `also` are held."""
    free, _ = model.prescribed(wave, [*model.held("mount"), *(also or [])])
    out = np.zeros_like(loads)
    inside = model.solver.free_part(model.stiffness(wave), free)
    out[free] = model.solver.solve(inside, loads[free])
    return out
