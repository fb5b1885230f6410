"""Contact forces at a torque: F ≥ 0 where gaps are closed, springs of Hertz's law among them.

The forces minimise the complementary energy ½ F·S F + Φ(F) + g·F over F ≥ 0 with −c·F = T; the rotation θ is
the multiplier. So they are unique, and the gaps are g + c θ + S F + δ(F) ≥ 0. Solved as
`fea.axisymmetric.lift_off` does, by Mehrotra's predictor and corrector (SIAM J. Optim. 2 (1992) 575-601),
with the one equation beside; δ(F) = C F^(2/3) enters each Newton step by its slope. Beside an equilibrium
that is known only places that are near are solved for; then all gaps are looked at.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dpotrf, dpotrs

from flexspline.fea.interior_point import CENTRING, room
from flexspline.geometry.errors import ComputationError

EPS = 1e-11
"""Forces times gaps, and what gaps and torque are off by, end below this share of the largest. With 1e-9
places that barely touch turned one of 35 random gears by 0.2 % of its angle."""
MOST_ROUNDS = 120
"""35 random designs took up to 32 at 1330 torques, 19 in the median."""
BACK = 0.99
"""Share of the way to the nearest bound that a step may go."""
LOADED = 1e-5
"""Of the largest force: what is below is not in contact. Where gaps are open some 1e-8 is left."""


NEAR = 0.02
"""Of the largest gap: places that open by more in the state before are left out at first. Which ones only
costs time: with 0.1 a curve takes twice as long, with 0.01 as long."""


LEAST_FORCE, LEAST_GAP = 1e-2, 1e-3
"""Shares of the largest, where a solve beside a known state begins; tenfold more or less takes the same
rounds, and a fifth fewer than from equal gaps."""


class EquilibriumError(ComputationError):
    """No equilibrium was found; the message carries the numbers."""


@dataclass(frozen=True)
class Contacts:
    """k places that can touch.

    Attributes
    ----------
    free : (k,) gaps [mm] with no forces and θ = 0.
    compliance : (k, k) gap per force [mm/N], symmetric, positive semidefinite.
    turning : (k,) c: gap per rotation [mm/rad]; the forces' torque is −c·F [N·mm].
    hertz : (k,) C [mm/N^(2/3)], 0 where there is none.
    """

    free: np.ndarray
    compliance: np.ndarray
    turning: np.ndarray
    hertz: np.ndarray

    def gaps(self, forces: np.ndarray, rotation: float) -> np.ndarray:
        """(k,) [mm]; `forces` are 0 at most places."""
        on = np.flatnonzero(forces)
        pushed = self.compliance[:, on] @ forces[on]
        return self.free + rotation * self.turning + pushed + self.hertz * forces ** (2 / 3)

    def among(self, places: np.ndarray) -> Contacts:
        """Of these places alone (j,)."""
        return Contacts(
            self.free[places],
            self.compliance[np.ix_(places, places)],
            self.turning[places],
            self.hertz[places],
        )


@dataclass(frozen=True)
class Equilibrium:
    """Forces (k,) [N], rotation [rad], and its slope dθ/dT [rad/(N·mm)] with forces' slopes dF/dT [1/mm]."""

    torque: float
    rotation: float
    forces: np.ndarray
    slope: float
    forces_slope: np.ndarray

    @property
    def loaded(self) -> np.ndarray:
        """(k,) which places carry."""
        return self.forces > LOADED * self.forces.max()


def equilibrium(at: Contacts, torque: float, start: Equilibrium | None = None) -> Equilibrium:
    """At a torque [N·mm]; `start`: an equilibrium near the answer, or none.

    Raises
    ------
    EquilibriumError : it did not settle, or no contact can carry that torque.
    """
    if torque and not (at.turning * torque < 0).any():
        raise EquilibriumError("no tooth within reach can carry a torque")
    if start is None or not start.forces.max() > 0:
        forces, rotation = _settled(at, torque, None)
    else:
        forces, rotation = _beside(at, torque, start)
    slope, forces_slope = _tangent(at, forces)
    return Equilibrium(torque, rotation, forces, slope, forces_slope)


@dataclass(frozen=True)
class _Guess:
    """Where the interior-point method begins beside a known equilibrium: forces and gaps (k,), rotation."""

    forces: np.ndarray
    gaps: np.ndarray
    rotation: float


def _beside(at: Contacts, torque: float, start: Equilibrium) -> tuple[np.ndarray, float]:
    """Forces (k,) and rotation, solved for among ever more places until no gap is below 0."""
    if torque * start.torque < 0:  # other flanks carry there
        return _settled(at, torque, None)
    size = float(np.abs(at.free).max())
    here = at.gaps(np.where(start.loaded, start.forces, 0.0), start.rotation)
    kept = start.loaded | (here < NEAR * size)
    while True:
        places = np.flatnonzero(kept)
        forces = np.zeros(len(at.free))
        try:
            guess = _Guess(start.forces[places], here[places], start.rotation)
            few, rotation = _settled(at.among(places), torque, guess)
        except EquilibriumError:  # too few to carry it
            return _settled(at, torque, None)
        forces[places] = few
        crossed = ~kept & (at.gaps(forces, rotation) < 0)
        if not crossed.any():
            return forces, rotation
        kept = kept | crossed


def _settled(at: Contacts, torque: float, beside: _Guess | None) -> tuple[np.ndarray, float]:
    matrix, turning = at.compliance, at.turning
    size = float(np.abs(at.free).max())
    arm = float(np.abs(turning).max())
    typical = max(size / float(matrix.diagonal().mean()), abs(torque) / arm)
    if beside is None or not beside.forces.max() > 0:
        force, gap = np.full(len(at.free), typical), np.full(len(at.free), size)
        rotation = 0.0
    else:
        start = beside.forces
        typical = float(start.max())
        force = np.maximum(start, LEAST_FORCE * typical)
        rotation = beside.rotation
        gap = np.maximum(beside.gaps, LEAST_GAP * size)
    places = np.arange(len(force))
    for _ in range(MOST_ROUNDS):
        spring = at.hertz * force ** (2 / 3)
        fits = at.free + rotation * turning + matrix @ force + spring
        off, lack = gap - fits, torque + float(turning @ force)
        both = force * gap
        if (
            np.abs(off).max() < EPS * size
            and abs(lack) < EPS * arm * force.max()
            and both.max() < EPS * size * force.max()
        ):
            return force, rotation
        if not np.isfinite(both).all():
            raise EquilibriumError("the contact forces did not settle: nothing holds the gear")
        diagonal = gap / force + 2 / 3 * at.hertz * force ** (-1 / 3)
        # LAPACK itself: at this size scipy's checks and copies take as long as the solves
        stiff = matrix.T.copy(order="F")
        stiff[places, places] += diagonal
        factor, fault = dpotrf(stiff, lower=1, clean=0, overwrite_a=1)
        if fault:
            raise EquilibriumError(
                f"the contact forces did not settle: row {fault} of their compliance is not positive"
            )
        plain, aside = dpotrs(factor, np.array([off - gap, turning]).T, lower=1)[0].T
        weight = float(turning @ aside)

        def towards(by: np.ndarray, product: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
            """Newton step to forces times gaps larger by `product`, to gaps that fit and the torque.

            `by`: the step of the forces without a turn.
            """
            turn = (float(turning @ by) + lack) / weight  # noqa: B023  (called in this round only)
            by = by - turn * aside  # noqa: B023
            return by, (product - gap * by) / force, turn  # noqa: B023

        push, lift, _ = towards(plain, -both)
        reach = room(force, push, gap, lift)
        left = ((force + reach * push) * (gap + reach * lift)).mean() / both.mean()
        product = left**CENTRING * both.mean() - both - push * lift
        push, lift, turn = towards(dpotrs(factor, product / force + off, lower=1)[0], product)
        reach = BACK * room(force, push, gap, lift)
        force, gap, rotation = force + reach * push, gap + reach * lift, rotation + reach * turn
    raise EquilibriumError(
        f"the contact forces did not settle in {MOST_ROUNDS} rounds: force times gap is "
        f"{both.max() / (size * force.max()):.1e} of the largest, allowed {EPS:.0e}"
    )


def _tangent(at: Contacts, forces: np.ndarray) -> tuple[float, np.ndarray]:
    """dθ/dT and dF/dT while the same places stay in contact."""
    on = np.flatnonzero(forces > LOADED * forces.max())
    stiff = at.compliance[np.ix_(on, on)] + np.diag(2 / 3 * at.hertz[on] * forces[on] ** (-1 / 3))
    aside = np.linalg.solve(stiff, at.turning[on])
    weight = float(at.turning[on] @ aside)
    if not weight > 0:  # nothing that carries can turn
        return np.inf, np.zeros_like(forces)
    slope = 1 / weight  # S dF + c dθ = 0 and c·dF = −dT
    found = np.zeros_like(forces)
    found[on] = -aside * slope
    return slope, found
