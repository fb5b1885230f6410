"""A body of revolution condensed to a few places: displacement per force, harmonic by harmonic.

A `Port` is a way to push on the body's circles: nodal forces on the meridian in one direction, all of them
together 1 N per radian. Everything repeats after half a turn (two lobes), so only even harmonics occur, and
a point force stands at φ and at φ + π.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement
from math import pi

import numpy as np

from flexspline.fea.axisymmetric.harmonics import Fixed, Harmonic, HarmonicModel
from flexspline.fea.axisymmetric.seat import responses
from flexspline.fea.cylindrical import RADIAL, TANGENTIAL


@dataclass(frozen=True)
class Port:
    """Where and how the body is pushed: `weights` (count,) of the P2 numbers add up to 1."""

    component: int
    weights: np.ndarray


@dataclass(frozen=True)
class Condensed:
    """Displacement per force of p ports.

    Attributes
    ----------
    tangential : (p,) whether a port pushes tangentially, else radially outwards.
    harmonics : (h, p, p) amplitudes of the harmonics 0, 2, … 2(h − 1) [mm per N/rad]: radial ones go with
        cos nφ, tangential ones with sin nφ (of n = 0: the rotation about the axis).
    """

    tangential: np.ndarray
    harmonics: np.ndarray

    @property
    def last(self) -> int:
        """The highest harmonic."""
        return 2 * (len(self.harmonics) - 1)

    def compliance(self, port: np.ndarray, angle: np.ndarray) -> np.ndarray:
        """Displacement (k, k) per point force [mm/N] among points: port numbers and angles [rad], (k,) each.

        A pair of forces F at φ_j and φ_j + π is (F/π)(1 + 2 Σ cos n(φ − φ_j)) N/rad; the last harmonic counts
        once, as in a discrete Fourier series.
        """
        n = 2.0 * np.arange(len(self.harmonics))
        times = np.where((n == 0) | (n == self.last), 1, 2) / pi
        phase = np.exp(-1j * n[:, None] * angle) * np.where(self.tangential[port], 1j, 1)
        waves = np.concatenate([phase.real, phase.imag])
        total = np.zeros((len(port), len(port)))
        at = {int(one): np.flatnonzero(port == one) for one in np.unique(port)}
        # a product of matrices for each pair of ports: a tenth of the time of a sum over harmonics
        for (i, rows), (j, columns) in combinations_with_replacement(at.items(), 2):
            weighted = np.tile(times * self.harmonics[:, i, j], 2)[:, None] * waves[:, columns]
            block = waves[:, rows].T @ weighted
            total[np.ix_(rows, columns)] = block if i != j else (block + block.T) / 2
            if i != j:
                total[np.ix_(columns, rows)] = block.T
        return total


def condensed(
    model: HarmonicModel,
    ports: Sequence[Port],
    last: int,
    held: Sequence[Fixed] = (),
    loose: Sequence[Fixed] = (),
) -> Condensed:
    """Condense the even harmonics up to `last`; `mount` is held.

    `held`: what else is fixed; `loose`: in the harmonic 0 only, for a body without a mount.

    Raises
    ------
    HarmonicError, RuntimeError : the body is not held.
    """
    if last % 2:
        raise ValueError("the last harmonic must be even")
    tangential = np.array([port.component == TANGENTIAL for port in ports])
    loads = np.zeros((3 * model.space.count, len(ports)))
    for column, port in enumerate(ports):
        loads[port.component :: 3, column] = port.weights
    matrices = []
    for n in range(0, last + 1, 2):
        waves = [Harmonic(n)] if n else [Harmonic(0), Harmonic(0, torsion=True)]
        matrix = np.zeros((len(ports), len(ports)))
        for wave in waves:
            mine = np.ones(len(ports), bool) if n else tangential == wave.torsion
            if not mine.any():
                continue
            pushes = loads[:, mine]
            # a density of 1 N/rad times cos nφ has the nodal amplitude ∫ cos² nφ dφ
            fixed = [*held, *(() if n or wave.torsion else loose)]
            moved = responses(model, wave, wave.around * pushes, fixed)
            block = pushes.T @ moved
            matrix[np.ix_(mine, mine)] = (block + block.T) / 2
        matrices.append(matrix)
    return Condensed(tangential, np.stack(matrices))


def even(model: HarmonicModel, patch: str, component: int) -> Port:
    """An even traction on a straight patch; its displacement is the patch's mean."""
    forces = model.pressed(patch, RADIAL, Harmonic(0))[RADIAL::3]
    return Port(component, forces / forces.sum())


def along(model: HarmonicModel, patch: str, at: np.ndarray, component: int = RADIAL) -> list[Port]:
    """Tractions on a cylinder, each a hat over z from one of `at` (m,) [mm], rising, to the next.

    Raises
    ------
    ValueError : the mesh has no node under a hat.
    """
    return [Port(component, hat / hat.sum()) for hat in _hats(model, patch, at)]


def shares_along(model: HarmonicModel, patch: str, at: np.ndarray) -> np.ndarray:
    """(m,) of the patch's area, that each of the hats of `along` stands for; errors as there."""
    areas = _hats(model, patch, at).sum(axis=1)
    return areas / areas.sum()


def _hats(model: HarmonicModel, patch: str, at: np.ndarray) -> np.ndarray:
    """(m, count) area [mm²] under each hat by P2 number; together they are the patch."""
    forces = model.pressed(patch, RADIAL, Harmonic(0))[RADIAL::3]
    z = model.space.places[:, 1]
    hats = np.array([forces * np.interp(z, at, one) for one in np.eye(len(at))])
    if not (hats.sum(axis=1) > 0).all():
        raise ValueError(f"{patch} has too few nodes for {len(at)} places")
    return hats
