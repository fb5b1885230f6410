"""The p-value of a test that looks at one residual in several ways and speaks of the best."""

from __future__ import annotations

import numpy as np


def p_value_of_best(p_value: float, looks: int, independent: bool = False) -> float:
    """p-value of the best of so many looks, which by itself has `p_value`.

    Looks at the same rows, as by blocks of several lengths, have noise in common, nobody knows how much.
    Whatever they share, the chance that one of k lies below p is at most k·p (Bonferroni). Of `independent`
    looks it is 1 − (1 − p)^k (Šidák, J. Am. Stat. Assoc. 62, 626 (1967)).
    """
    if independent:
        return float(-np.expm1(looks * np.log1p(-p_value)))
    return min(1.0, looks * p_value)
