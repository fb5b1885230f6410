"""Friction: five families of hysteresis in the torque's history, whatever its rate.

Each respond(q) takes load / peak along the path and returns the friction's share of the torque
balance, about −1…1, which the twist lacks: twist = elastic − w·respond(q).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy import stats
from scipy.stats import qmc

from hidden.effect import Hidden, Setting

Respond = Callable[[np.ndarray], np.ndarray]
FINE = 0.02
"""Longest step in load / peak, as a share of the law's own pre-sliding length."""


def draw_friction(s: Setting, rng: np.random.Generator) -> Hidden:
    """Width from 4 to 25 % of the wind-up, by a law drawn from the five families."""
    respond, law = FAMILIES[int(rng.integers(len(FAMILIES)))](rng)
    width = s.windup * s.size(0.04, 0.1, 0.25, rng)
    scale = width / closed_loop_width(respond)
    return Hidden(
        "friction_hysteresis",
        width,
        f"friction {law}, width {width:.2f}″",
        lambda program, gear: -scale * respond(program.torque / s.program.peak),
    )


def closed_loop_width(respond: Respond, steps: int = 400) -> float:
    """Width at zero load of the third loop ±1: descending branch less ascending branch of −respond."""
    leg = np.linspace(0, 1, steps + 1)[1:]
    loop = np.concatenate([leg, 1 - leg, -leg, leg - 1])
    out = respond(np.concatenate([[0.0], np.tile(loop, 3)]))[-4 * steps :]
    down, up = out[2 * steps - 1], out[-1]
    return float(up - down)


def bouc_wen(rng: np.random.Generator) -> tuple[Respond, str]:
    """dz = (dq/δ)(1 − |z|ⁿ(β sgn(dq z) + 1 − β))."""
    length, n, beta = rng.uniform(0.03, 0.2), rng.uniform(0.8, 2.5), rng.uniform(0.5, 0.8)

    def slope(z: float, sign: float) -> float:
        return (1 - abs(z) ** n * (beta * np.sign(sign * z) + 1 - beta)) / length

    law = f"Bouc-Wen δ={length:.3f} n={n:.2f} β={beta:.2f}"
    return lambda q: _integrated(q, slope, length), law


def dahl(rng: np.random.Generator) -> tuple[Respond, str]:
    """Dahl, which is LuGre without rate: dz = (dq/δ)(1 − z sgn dq)^a."""
    length, a = rng.uniform(0.03, 0.15), rng.uniform(0.7, 1.6)

    def slope(z: float, sign: float) -> float:
        return max(1 - z * sign, 0.0) ** a / length

    return lambda q: _integrated(q, slope, length), f"Dahl δ={length:.3f} a={a:.2f}"


def maxwell_slip(rng: np.random.Generator) -> tuple[Respond, str]:
    """Springs that slip, side by side, with random limits and weights."""
    n = int(rng.integers(3, 9))
    limit = np.exp(rng.uniform(np.log(0.01), np.log(0.45), n))
    weight = rng.dirichlet(np.full(n, 1.5))
    law = f"Maxwell slip of {n}, limits {limit.min():.3f}…{limit.max():.3f}"
    return lambda q: slipping(q, limit) @ (weight / limit), law


def preisach(rng: np.random.Generator) -> tuple[Respond, str]:
    """Relays with thresholds spread about the diagonal; the balance is their mean less their state."""
    shape, wide, spread = rng.uniform(1.5, 4), rng.uniform(0.04, 0.16), rng.uniform(0.25, 0.5)
    place = qmc.Sobol(2, seed=rng).random(2048)  # even: a random draw would make ripples of its own
    half = stats.gamma(shape, scale=wide / shape).ppf(place[:, 0])
    centre = stats.norm(0, spread).ppf(place[:, 1])
    inside = (centre + half < 0.98) & (centre - half > -0.98)
    up, down = (centre + half)[inside], (centre - half)[inside]
    up_sorted, down_sorted = np.sort(up), np.sort(down)

    def respond(q: np.ndarray) -> np.ndarray:
        state, out = np.where(up + down < 0, 1.0, -1.0), np.empty_like(q)
        for k, x in enumerate(q):
            state[up <= x] = 1
            state[down >= x] = -1
            out[k] = state.mean()
        mean = np.searchsorted(up_sorted, q, "right") + np.searchsorted(down_sorted, q)
        return mean / len(up) - 1 - out

    return (
        respond,
        f"Preisach, half widths gamma({shape:.1f}) of mean {wide:.3f}, spread {spread:.2f}",
    )


def load_dependent(rng: np.random.Generator) -> tuple[Respond, str]:
    """Coulomb friction part constant, part growing with the load carried."""
    length, part, power = rng.uniform(0.01, 0.05), rng.uniform(0.2, 1.2), rng.uniform(0.8, 1.5)

    def slope(z: float, sign: float) -> float:
        return (1 - z * sign) / length

    law = f"Coulomb 1 + {part:.2f}|q|^{power:.2f}, δ={length:.3f}"
    return lambda q: _integrated(q, slope, length) * (1 + part * np.abs(q) ** power), law


def slipping(q: np.ndarray, limit: np.ndarray) -> np.ndarray:
    """Stretch of each spring-slider, (len(q), len(limit)): it follows q and slips at ± its limit."""
    z, out = np.zeros(len(limit)), np.empty((len(q), len(limit)))
    before = 0.0
    for k, x in enumerate(q):
        z = np.minimum(np.maximum(z + (x - before), -limit), limit)
        before, out[k] = x, z
    return out


def _integrated(q: np.ndarray, slope: Callable[[float, float], float], length: float) -> np.ndarray:
    """Explicit midpoint steps no longer than a fraction of the law's length."""
    out, z, before = np.empty_like(q), 0.0, 0.0
    for k, x in enumerate(q):
        step = x - before
        if step:
            parts = int(abs(step) / (4 * FINE * length)) + 1
            h, sign = step / parts, np.sign(step)
            for _ in range(parts):
                half = z + slope(z, sign) * h / 2
                z = min(max(z + slope(half, sign) * h, -1.0), 1.0)
        before, out[k] = x, z
    return out


FAMILIES = (bouc_wen, dahl, maxwell_slip, preisach, load_dependent)
