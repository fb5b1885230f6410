"""Contact forces at a torque: F ≥ 0 where gaps are closed, springs of Hertz's law among them.

The forces minimise the complementary energy ½ F·S F + Φ(F) + g·F over F ≥ 0 with −c·F = T; the rotation θ is
the multiplier. So they are unique, and the gaps are g + c θ + S F + δ(F) ≥ 0. Solved as
`fea.axisymmetric.lift_off` does, by Mehrotra's predictor and corrector (SIAM J. Optim. 2 (1992) 575-601),
with the one equation beside; δ(F) = C F^(2/3) enters each Newton step by its slope. Beside an equilibrium
that is known the contacts of that one are tried first: Newton's method among them alone, where a force below
0 leaves and a gap below 0 enters (Hintermüller, Ito, Kunisch, SIAM J. Optim. 13 (2002) 865-888). Where these
do not settle, and at a torque the other way, all starts over.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dpotrf, dpotrs

from flexspline.fea.interior_point import corrected, room
from flexspline.geometry.errors import ComputationError

GEAR_RESIDUAL = 1e-11
"""The iteration ends when force times gap, and the residuals of gaps and torque, are below this share of the
largest. With 1e-9, contacts that barely touch changed the angle of one of 35 random gears by 0.2 %."""
MOST_ROUNDS = 120
"""Most rounds. 35 random designs took up to 32 at 1330 torques, with a median of 19."""
GEAR_STEP_SHARE = 0.99
"""Share of the way to the nearest bound that a step may go. Judgement: a little less than on the seat, since
the balls' law is not linear."""
LEAST_FORCE_SHARE = 1e-5
"""A contact with less than this share of the largest force counts as open. Where gaps are open, about 1e-8 is
left."""
MOST_CHANGES = 60
"""Most Newton steps from a known state: 323 solves of 19 random gears took up to 31, with a median of 4. A
step takes a tenth of the time of an interior-point round, which includes all contacts."""


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
        return self.forces > LEAST_FORCE_SHARE * self.forces.max()


def equilibrium(at: Contacts, torque: float, start: Equilibrium | None = None) -> Equilibrium:
    """At a torque [N·mm]; `start`: an equilibrium near the answer, or none.

    Raises
    ------
    EquilibriumError : it did not settle, or no contact can carry that torque.
    """
    if torque and not (at.turning * torque < 0).any():
        raise EquilibriumError("no tooth within reach can carry a torque")
    known = None
    if start is not None and start.forces.max() > 0:
        known = _among_contacts(at, torque, start)
    forces, rotation = known or _settled(at, torque)
    slope, forces_slope = _tangent(at, forces)
    return Equilibrium(torque, rotation, forces, slope, forces_slope)


def _among_contacts(
    at: Contacts, torque: float, start: Equilibrium
) -> tuple[np.ndarray, float] | None:
    """Forces (k,) and rotation from those of a known state, None where its contacts are too far off."""
    if torque * start.torque < 0:  # other flanks carry there
        return None
    size, arm = float(np.abs(at.free).max()), float(np.abs(at.turning).max())
    on, forces, rotation = start.loaded, start.forces, start.rotation
    for _ in range(MOST_CHANGES):
        i = np.flatnonzero(on)
        if not len(i):  # all of them pulled
            return None
        force, turning, hertz = forces[i], at.turning[i], at.hertz[i]
        ball = hertz > 0
        matrix = at.compliance[np.ix_(i, i)]
        residual = -(at.free[i] + rotation * turning + matrix @ force + hertz * force ** (2 / 3))
        matrix[ball, ball] += 2 / 3 * hertz[ball] * force[ball] ** (-1 / 3)
        factor, fault = dpotrf(matrix.T, lower=1, clean=0)
        if fault:
            return None
        by, aside = dpotrs(factor, np.array([residual, turning]).T, lower=1)[0].T
        weight = float(turning @ aside)
        if not weight > 0:  # none of these can carry a torque
            return None
        turn = (float(turning @ by) + torque + float(turning @ force)) / weight
        force, rotation = force + by - turn * aside, rotation + turn
        pulls = force <= 0
        gaps = at.free + rotation * at.turning + force @ at.compliance[i]
        enter = ~on & (gaps < -GEAR_RESIDUAL * size)
        if not pulls.any() and not enter.any():
            left = gaps[i] + hertz * force ** (2 / 3)
            lack = abs(torque + float(turning @ force))
            if (
                np.abs(left).max() < GEAR_RESIDUAL * size
                and lack < GEAR_RESIDUAL * arm * force.max()
            ):
                all_forces = np.zeros(len(at.free))
                all_forces[i] = force
                return all_forces, rotation
        forces = np.zeros(len(at.free))
        forces[i] = np.maximum(force, 0)
        ball = enter & (at.hertz > 0)
        forces[ball] = (-gaps[ball] / at.hertz[ball]) ** 1.5
        on = (forces > 0) | enter
    return None


def _settled(at: Contacts, torque: float) -> tuple[np.ndarray, float]:
    """Forces (k,) and rotation, from nothing."""
    matrix, turning = at.compliance, at.turning
    size = float(np.abs(at.free).max())
    arm = float(np.abs(turning).max())
    typical = max(size / float(matrix.diagonal().mean()), abs(torque) / arm)
    force, gap, rotation = np.full(len(at.free), typical), np.full(len(at.free), size), 0.0
    places = np.arange(len(force))
    for _ in range(MOST_ROUNDS):
        spring = at.hertz * force ** (2 / 3)
        fits = at.free + rotation * turning + matrix @ force + spring
        residual, lack = gap - fits, torque + float(turning @ force)
        both = force * gap
        if (
            np.abs(residual).max() < GEAR_RESIDUAL * size
            and abs(lack) < GEAR_RESIDUAL * arm * force.max()
            and both.max() < GEAR_RESIDUAL * size * force.max()
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
        plain, aside = dpotrs(factor, np.array([residual - gap, turning]).T, lower=1)[0].T
        weight = float(turning @ aside)

        def towards(by: np.ndarray, product: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
            """Newton step to forces times gaps larger by `product`, to gaps that fit and the torque.

            `by`: the step of the forces without a turn.
            """
            turn = (float(turning @ by) + lack) / weight  # noqa: B023  (called in this round only)
            by = by - turn * aside  # noqa: B023
            return by, (product - gap * by) / force, turn  # noqa: B023

        push, lift, _ = towards(plain, -both)
        product = corrected(force, gap, push, lift)
        push, lift, turn = towards(dpotrs(factor, product / force + residual, lower=1)[0], product)
        reach = GEAR_STEP_SHARE * room(force, push, gap, lift)
        force, gap, rotation = force + reach * push, gap + reach * lift, rotation + reach * turn
    raise EquilibriumError(
        f"the contact forces did not settle in {MOST_ROUNDS} rounds: force times gap is "
        f"{both.max() / (size * force.max()):.1e} of the largest, allowed {GEAR_RESIDUAL:.0e}"
    )


def _tangent(at: Contacts, forces: np.ndarray) -> tuple[float, np.ndarray]:
    """dθ/dT and dF/dT while the same places stay in contact."""
    on = np.flatnonzero(forces > LEAST_FORCE_SHARE * forces.max())
    stiff = at.compliance[np.ix_(on, on)] + np.diag(2 / 3 * at.hertz[on] * forces[on] ** (-1 / 3))
    aside = np.linalg.solve(stiff, at.turning[on])
    weight = float(at.turning[on] @ aside)
    if not weight > 0:  # nothing that carries can turn
        return np.inf, np.zeros_like(forces)
    slope = 1 / weight  # S dF + c dθ = 0 and c·dF = −dT
    forces_slope = np.zeros_like(forces)
    forces_slope[on] = -aside * slope
    return slope, forces_slope
