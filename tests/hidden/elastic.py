"""Effects in the elastic twist: hardening, a missing compliance, a direction, a position."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from hidden.effect import CannotShowError, Hidden, Setting

Curve = Callable[[np.ndarray], np.ndarray]
"""Twist / (compliance · peak) against load / peak, odd, growing, its slope falling with |load|."""


def draw_hardening(s: Setting, rng: np.random.Generator) -> Hidden:
    """A curve whose end chord is 1.15 to 2 times as stiff as its first one."""
    ratio = 1 + s.size(0.15, 0.4, 0.85, rng)
    shape, law = CURVES[int(rng.integers(len(CURVES)))](rng)
    low = rng.random() < 0.35  # the simulation may be right for small loads or for large ones

    def curve(strength: float) -> Curve:
        raw = shape(strength)
        if low:
            slope = float(raw(np.array(1e-4))) / 1e-4
        else:
            slope = float(raw(np.array(1.0)) - raw(np.array(0.98))) / 0.02
        return lambda q: raw(q) / slope

    top = 1e-3
    while hardening_ratio(curve(top)) < ratio and top < 1e4:
        top *= 2
    if top >= 1e4:
        return draw_hardening(s, rng)
    strength = brentq(lambda k: hardening_ratio(curve(k)) - ratio, 1e-4, top)
    chosen, scale = curve(strength), s.windup
    return Hidden(
        "stiffness_hardening",
        hardening_ratio(chosen),
        f"hardening {law}, strength {strength:.3g}, nominal at {'small' if low else 'large'} loads",
        lambda p, g: scale * (chosen(p.torque / s.program.peak) - p.torque / s.program.peak),
    )


def hardening_ratio(curve: Curve) -> float:
    """Chord stiffness over 80–100 % of the largest torque by the one over 5–20 %."""
    y = curve(np.array([0.05, 0.2, 0.8, 1.0]))
    return float((0.2 / (y[3] - y[2])) / (0.15 / (y[1] - y[0])))


def segments(rng: np.random.Generator) -> tuple[Callable[[float], Curve], str]:
    """K1 up to T1, K2 up to T2, K3 beyond; shares of the rise at random (hd_torsional_stiffness)."""
    t1, t2 = rng.uniform(0.1, 0.35), rng.uniform(0.42, 0.78)
    share = rng.uniform(0.25, 0.75)

    def make(k: float) -> Curve:
        def curve(q: np.ndarray) -> np.ndarray:
            a = np.abs(q)
            soft = k * (share * np.minimum(a, t1) + (1 - share) * np.minimum(a, t2))
            return np.sign(q) * (a + soft)

        return curve

    return make, f"K1-K2-K3, T1={t1:.2f}, T2={t2:.2f}"


def power_law(rng: np.random.Generator) -> tuple[Callable[[float], Curve], str]:
    """Twist ∝ load^p from an offset on, p falling below 1 with strength."""
    q0 = rng.uniform(0.02, 0.1)

    def make(k: float) -> Curve:
        p = 1 / (1 + k)
        return lambda q: np.sign(q) * ((np.abs(q) + q0) ** p - q0**p)

    return make, f"power law from {q0:.2f}"


def cubic_stiffness(rng: np.random.Generator) -> tuple[Callable[[float], Curve], str]:
    """Load = twist + k·twist³, solved for the twist (Cardano)."""

    def make(k: float) -> Curve:
        root = np.sqrt(3 / k) / 3
        return lambda q: 6 * root * np.sinh(np.arcsinh(3 * q / (2 * 3 * root)) / 3)

    return make, "cubic stiffness"


def tanh_windup(rng: np.random.Generator) -> tuple[Callable[[float], Curve], str]:
    """A soft wind-up that is used up: q + k·a·tanh(q/a)."""
    a = rng.uniform(0.08, 0.4)
    return lambda k: lambda q: q + k * a * np.tanh(q / a), f"tanh wind-up a={a:.2f}"


def rational(rng: np.random.Generator) -> tuple[Callable[[float], Curve], str]:
    """q + k·q/(1 + |q|/a): contact that closes."""
    a = rng.uniform(0.1, 0.6)
    return lambda k: lambda q: q + k * q / (1 + np.abs(q) / a), f"rational a={a:.2f}"


CURVES = (segments, power_law, cubic_stiffness, tanh_windup, rational)


def draw_series(s: Setting, rng: np.random.Generator) -> Hidden:
    """A spring left out, in a few cases one counted that is not there."""
    share = s.size(0.17, 0.3, 0.6, rng)
    if rng.random() < 0.25:
        share = -min(share, 0.4)
    extra = share * s.rig.compliance
    total = (s.gear.compliance + extra) / s.rig.compliance - 1
    return Hidden(
        "series_compliance",
        100 * total,
        f"{100 * share:+.1f} % compliance on a gear drawn {100 * (total - share):+.1f} % off",
        lambda p, g: extra * p.torque,
    )


def draw_asymmetry(s: Setting, rng: np.random.Generator) -> Hidden:
    """Stiffer one way: twist less by a corner, a rounded corner or a power of |q|."""
    percent = s.size(4, 9, 20, rng) * rng.choice([-1, 1])
    kind = str(rng.choice(["corner", "rounded", "power"]))
    round_, power = rng.uniform(0.01, 0.08), rng.uniform(0.9, 1.15)

    def even(q: np.ndarray) -> np.ndarray:
        if kind == "corner":
            return np.abs(q)
        if kind == "power":
            return np.abs(q) ** power
        return np.sqrt(q * q + round_**2) - round_

    end = float(even(np.array(1.0)))
    strength = brentq(lambda k: chord_asymmetry(1 - k * end, 1 + k * end) - percent, -0.45, 0.45)
    scale = s.windup * strength
    return Hidden(
        "direction_asymmetry",
        chord_asymmetry(1 - strength * end, 1 + strength * end),
        f"asymmetry {percent:+.1f} %, {kind}",
        lambda p, g: -scale * even(p.torque / s.program.peak),
    )


def chord_asymmetry(twist_plus: float, twist_minus: float) -> float:
    """(K₊ − K₋)/((K₊ + K₋)/2) in %, of the twists at ± the largest torque."""
    k_plus, k_minus = 1 / twist_plus, 1 / twist_minus
    return 100 * (k_plus - k_minus) / ((k_plus + k_minus) / 2)


def draw_position_stiffness(s: Setting, rng: np.random.Generator) -> Hidden:
    """Compliance with harmonics 1, 2, 4 of the wave generator's angle, one of them leading."""
    if not tells_harmonics(s.program.position, s.program.cycle):
        raise CannotShowError("too few positions for their harmonics")
    share = min(s.size(0.04, 0.09, 0.2, rng), 0.4)
    amplitude, phase, said = harmonics(rng)
    scale = share * s.gear.compliance
    return Hidden(
        "position_stiffness",
        100 * share,
        f"compliance ± {100 * share:.1f} %, harmonics {said}",
        lambda p, g: scale * p.torque * periodic(p.position, amplitude, phase),
    )


HARMONICS = np.array([1, 2, 4])


def harmonics(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, str]:
    """Amplitudes of harmonics 1, 2, 4 (the largest is 1), phases [rad], and both in words."""
    amplitude = np.where(rng.random(3) < 0.5, 0.0, rng.uniform(0.05, 0.6, 3))
    amplitude[rng.choice(3, p=[0.25, 0.5, 0.25])] = 1.0
    said = ", ".join(f"{h}: {a:.2f}" for h, a in zip(HARMONICS, amplitude, strict=True) if a)
    return amplitude, rng.uniform(0, 2 * np.pi, 3), said


def fixes_harmonics(position_deg: np.ndarray) -> bool:
    """Whether zero and harmonics 1, 2, 4 each follow from the positions: 7 unknowns, well apart."""
    columns = _harmonic_columns(np.unique(position_deg))
    least = np.linalg.svd(columns, compute_uv=False)
    return len(columns) >= columns.shape[1] and bool(least[-1] > 0.2 * np.sqrt(len(columns)))


def tells_harmonics(position_deg: np.ndarray, cycle: np.ndarray) -> bool:
    """Whether harmonics are more than another name for a zero (or a K) of its own in each cycle.

    As many harmonics as cycles fit anything; two cycles to spare are asked for.
    """
    places = position_deg[np.unique(cycle, return_index=True)[1]]
    return len(places) >= int(np.linalg.matrix_rank(_harmonic_columns(places), tol=1e-6)) + 2


def _harmonic_columns(position_deg: np.ndarray) -> np.ndarray:
    turn = np.radians(position_deg)[:, None] * HARMONICS
    return np.concatenate([np.ones((len(turn), 1)), np.sin(turn), np.cos(turn)], axis=1)


def periodic(position_deg: np.ndarray, amplitude: np.ndarray, phase: np.ndarray) -> np.ndarray:
    turn = np.radians(position_deg)[:, None] * HARMONICS
    return np.sin(turn + phase) @ amplitude
