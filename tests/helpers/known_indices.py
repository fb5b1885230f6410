"""Functions of inputs that scatter, with Sobol indices in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from flexspline.pipeline.study.tolerance import ScatteredInput


@dataclass(frozen=True)
class Known:
    """A function (n, k) → (n,) of its inputs, and its indices (k,)."""

    inputs: tuple[ScatteredInput, ...]
    function: Callable[[np.ndarray], np.ndarray]
    first: np.ndarray
    total: np.ndarray


def uniform(key: str, half: float, nominal: float = 0.0) -> ScatteredInput:
    return ScatteredInput(key, nominal, half / 3**0.5, nominal - half, nominal + half, False)


def normal(key: str, std: float) -> ScatteredInput:
    return ScatteredInput(key, 0.0, std, -4 * std, 4 * std, True)


def moment(order: int) -> float:
    """⟨z^order⟩ of a standard normal number cut off at ± 4, from its density."""
    from scipy.integrate import quad

    def density(z: float) -> float:
        return float(np.exp(-z * z / 2))

    return quad(lambda z: z**order * density(z), -4, 4)[0] / quad(density, -4, 4)[0]


def ishigami() -> Known:
    """Ishigami and Homma, First Int. Symp. Uncertainty Modeling (1990) 398-403: a = 7, b = 0.1.

    V1 = (1 + bπ⁴/5)²/2, V2 = a²/8, V13 = b²π⁸(1/18 − 1/50), V the sum.
    """
    v1, v2 = (1 + 0.1 * np.pi**4 / 5) ** 2 / 2, 49 / 8
    v13 = 0.01 * np.pi**8 * (1 / 18 - 1 / 50)

    def f(x: np.ndarray) -> np.ndarray:
        return np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])

    whole = v1 + v2 + v13
    return Known(
        tuple(uniform(k, np.pi) for k in "abc"), f,
        np.array([v1, v2, 0.0]) / whole, np.array([v1 + v13, v2, v13]) / whole,
    )  # fmt: skip


def sobol_g() -> Known:
    """Saltelli and Sobol, Reliab. Eng. Syst. Saf. 50 (1995) 225-239.

    V_i = 1/(3(1 + a_i)²), V = Π(1 + V_i) − 1.
    """
    a = np.array([0.0, 1.0, 4.5, 9.0, 99.0, 99.0])
    v = 1 / 3 / (1 + a) ** 2

    def f(x: np.ndarray) -> np.ndarray:
        return np.prod((np.abs(4 * x - 2) + a) / (1 + a), axis=1)

    whole = np.prod(1 + v) - 1
    total = [own * np.prod(1 + np.delete(v, i)) for i, own in enumerate(v)]
    return Known(
        tuple(uniform(k, 0.5, 0.5) for k in "abcdef"), f, v / whole, np.array(total) / whole
    )


def linear() -> Known:
    """Equal scatter, unequal slopes: S_i = slope² over their sum."""
    slope = np.array([3.0, 2.0, 1.0, 0.5, 0.1])
    share = slope**2 / (slope**2).sum()
    return Known(tuple(uniform(k, 1.0) for k in "abcde"), lambda x: x @ slope, share, share)


def quadratic() -> Known:
    """x + y²/2 + xz of normal numbers: V1 = σ², V2 = (⟨y⁴⟩ − σ⁴)/4, V13 = σ⁴."""
    square, fourth = moment(2), moment(4)
    v1, v2, v13 = square, (fourth - square**2) / 4, square**2
    whole = v1 + v2 + v13
    return Known(
        tuple(normal(k, 1.0) for k in "abc"),
        lambda x: x[:, 0] + 0.5 * x[:, 1] ** 2 + x[:, 0] * x[:, 2],
        np.array([v1, v2, 0.0]) / whole, np.array([v1 + v13, v2, v13]) / whole,
    )  # fmt: skip


def additive() -> Known:
    """A sum of normal numbers, each with a variance of its own."""
    std = np.array([3.0, 2.0, 1.0, 0.3])
    share = std**2 / (std**2).sum()
    inputs = tuple(normal(k, float(s)) for k, s in zip("abcd", std, strict=True))
    return Known(inputs, lambda x: x.sum(axis=1), share, share)


def curved() -> Known:
    """x³ + y + exp(z)/3 of uniform numbers, additive and not quadratic."""
    v = np.array([1 / 7, 1 / 3, (np.sinh(2) / 2 - np.sinh(1) ** 2) / 9])
    share = v / v.sum()
    return Known(
        tuple(uniform(k, 1.0) for k in "abc"),
        lambda x: x[:, 0] ** 3 + x[:, 1] + np.exp(x[:, 2]) / 3, share, share,
    )  # fmt: skip


KNOWN = {f.__name__: f for f in (ishigami, sobol_g, linear, quadratic, additive, curved)}
