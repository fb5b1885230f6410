"""How likely the rows about a crossing of the gap are, if it is crossed at some torque.

A row's true torque is its reading less the place of the crossing and less the reading's noise, and that
alone says on which side of the gap it lies. So a row's angle is one side's or the other's, each with its
probability, and not a mean of both.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import ndtr

from flexspline.pipeline.diagnosis.robust import robust_std

MISFIT_RATIO = 1.5
"""Times the scatter beside the gap: noise is at least this, where the model misses more than noise."""
IN_GAP = 0.1
"""Of the rows at the place itself, those in the gap, anywhere in it: a rig rests there before and after its
cycles, and a record has 10 to 20 rows within the torque's noise of the place."""
OUTLIER_SHARE = 0.01
"""Share of the rows that are outliers of the crossing's model. Judgement."""
FEWEST_OF_MEDIAN = 3
"""Readings of a hold, from which their median is an outlier only if two of them are."""
SPIKE_REACH = 6.0
"""Times the noise, beside twice the gap, over which such a row may lie: three deviations either way."""
LEAST_WIDTH = 1e-4
"""Width of a crossing without torque noise, over the largest torque; below any torque cell's digits."""
FAR_SIDE = 5.0
"""Widths from the place beyond which a row's side is certain except for one in three million."""
STRAIGHT_ENDS = 8.0
"""Times the reading's noise, from which soft ends are as good as straight within it: the bend moves a row by
0.006 of half the gap at most (a hyperbolic tangent's second derivative is 0.77 at most, over 2·8²)."""
_nodes, _weights = np.polynomial.hermite_e.hermegauss(15)
"""Of a normal deviate: no farther apart than one of its deviations, the narrowest crossing."""
_weights /= _weights.sum()


@dataclass(frozen=True)
class Blur:
    """What blurs a crossing, in deviations of the torque's noise: the reading, and soft ends of the gap.

    Soft ends have the form of `crossing_forms.softly`: a hyperbolic tangent of the torque over their width.
    """

    reading: float
    ends: float = 0.0

    @property
    def reach(self) -> float:
        """The distance beyond which the side of a row is certain."""
        return FAR_SIDE * (self.reading + self.ends)


READINGS = (0.5, 1.0, 2.0)
"""A noise half and twice as large as estimated."""
NARROW_ENDS, ENDS_RATIO = 4.0, 2.0
"""Widths of soft ends that are always tried, from 1, each twice the last one."""
SOFTEST = 0.04
"""Of the largest torque: the first width beyond is the last one tried. Teeth that take up their load one
after another have ends of a hundredth; what is much softer bends the curve where stiffness is measured, and
is hardening."""
FORM_DOUBT = 0.3
"""Of half the gap, times the slope of soft ends, by which their form is unknown: within the ends' width, two
hyperbolic tangents of widths √2 apart differ by as much, and no width is farther from one that is tried at
first. It counts for each row by itself, though a form is wrong in all rows alike."""
FINER = (-0.75, -0.5, -0.25, 0.25, 0.5, 0.75)
"""Steps of the last ratio of widths, between which a width is looked for: where rows are denser on one side
of the crossing, a wrong width there is taken for another place."""


def blurs_of(width_share: float) -> tuple[Blur, ...]:
    """All that are tried, for a torque noise of that share of the largest torque.

    All are as likely before the rows are seen.
    """
    ends = [1.0]
    while ends[-1] < max(NARROW_ENDS, SOFTEST / width_share):
        ends.append(ENDS_RATIO * ends[-1])
    return (*map(Blur, READINGS), *(Blur(1.0, end) for end in ends))


def finer(blur: Blur, ratio: float) -> tuple[Blur, ...]:
    """Soft ends between those that are `ratio` times wider and narrower; none about sharp ones."""
    return tuple(Blur(1.0, blur.ends * ratio**step) for step in FINER) if blur.ends else ()


@dataclass(frozen=True)
class CrossingRows:
    """Rows in order of their torque.

    Attributes
    ----------
    torque_Nm, left_arcsec, gap_arcsec : (n,) readings; angle less everything but the gap; the row's own gap,
        which temperature or wear changes.
    noise_arcsec : of the angle. width_Nm : of the torque reading's noise.
    share : (n,) of that noise that a row has which is the mean of several.
    """

    torque_Nm: np.ndarray
    left_arcsec: np.ndarray
    gap_arcsec: np.ndarray
    noise_arcsec: float
    width_Nm: float
    share: np.ndarray

    @classmethod
    def of(
        cls,
        torque_Nm: np.ndarray,
        left_arcsec: np.ndarray,
        gap_arcsec: np.ndarray,
        noise_arcsec: float,
        width_Nm: float,
        readings: np.ndarray,
    ) -> CrossingRows:
        """What the model misses near zero is not evidence of a place: the noise is at least that."""
        order = np.argsort(torque_Nm)
        beside = np.abs(np.abs(left_arcsec) - gap_arcsec / 2)
        noise = max(noise_arcsec, MISFIT_RATIO * robust_std(beside))
        share = 1 / np.sqrt(readings[order])
        return cls(torque_Nm[order], left_arcsec[order], gap_arcsec[order], noise, width_Nm, share)

    def log_likelihood(self, places_Nm: np.ndarray, blurs: tuple[Blur, ...]) -> np.ndarray:
        """(p,) of the gap crossed at each place, whichever of the blurs is there."""
        each = np.array([self._blurred(places_Nm, b) for b in blurs])
        return np.asarray(np.logaddexp.reduce(each, axis=0) - np.log(len(blurs)))

    def likeliest(self, place_Nm: float, blurs: tuple[Blur, ...]) -> Blur:
        """Of the blurs, of the gap crossed at this place."""
        place = np.array([place_Nm])
        return max(blurs, key=lambda blur: float(self._blurred(place, blur)[0]))

    def _blurred(self, places_Nm: np.ndarray, blur: Blur) -> np.ndarray:
        """(p,) with one blur. Rows beyond its reach of every place are summed once, not place by place."""
        left, gap = self.left_arcsec, self.gap_arcsec
        below, above = self._on_one_side
        reach = blur.reach * self.width_Nm
        first = np.searchsorted(self.torque_Nm, places_Nm - reach)
        last = np.searchsorted(self.torque_Nm, places_Nm + reach)
        widest = int((last - first).max())
        at = first[:, None] + np.arange(widest)
        inside = at < last[:, None]
        at = np.minimum(at, len(self.torque_Nm) - 1)
        beyond = (self.torque_Nm[at] - places_Nm[:, None]) / self.width_Nm
        own = self._own(beyond, self.share[at], left[at], gap[at], blur)
        return np.asarray(
            below[first]
            + above[-1]
            - above[last]
            + np.where(inside, self._log(own, gap[at], self._outlying[at]), 0.0).sum(axis=1)
        )

    @cached_property
    def _on_one_side(self) -> tuple[np.ndarray, np.ndarray]:
        """(n + 1,) sums over the rows before each, were all of them below the gap, and above it."""
        half, left, gap = self.gap_arcsec / 2, self.left_arcsec, self.gap_arcsec
        below, above = (
            np.concatenate(
                [[0.0], np.cumsum(self._log(self._near(side * half, left), gap, self._outlying))]
            )
            for side in (-1, 1)
        )
        return below, above

    @cached_property
    def _outlying(self) -> np.ndarray:
        """(n,) probability that a row is an outlier."""
        of_median = self.share**-2 > FEWEST_OF_MEDIAN - 0.5
        return np.where(of_median, OUTLIER_SHARE**2, OUTLIER_SHARE)

    def _own(
        self, beyond: np.ndarray, share: np.ndarray, left: np.ndarray, gap: np.ndarray, blur: Blur
    ) -> np.ndarray:
        """Density of rows so many widths beyond the place, each with its share of the reading's noise."""
        half = gap / 2
        if blur.ends >= STRAIGHT_ENDS * blur.reading:
            return self._behind_softest_ends(beyond, left, half, blur)
        if blur.ends:
            return self._behind_soft_ends(beyond, share, left, half, blur)
        z = beyond / (share * blur.reading)
        up, in_gap = ndtr(z), IN_GAP * np.exp(-(z**2) / 2)
        either = up * self._near(half, left) + (1 - up) * self._near(-half, left)
        noise = self.noise_arcsec
        anywhere = (ndtr((left + half) / noise) - ndtr((left - half) / noise)) / gap
        return np.asarray((1 - in_gap) * either + in_gap * anywhere)

    def _behind_soft_ends(
        self, beyond: np.ndarray, share: np.ndarray, left: np.ndarray, half: np.ndarray, blur: Blur
    ) -> np.ndarray:
        """Density of rows `beyond` the place in widths: at each true torque the gap has a share of its step.

        In single precision, which takes a tenth of the time and is good to 1e-6 of a density.
        """
        in_noise = self._beside_soft_ends(np.tanh(beyond / blur.ends), half) * np.sqrt(2)
        place, step, angle, reading, nodes, weights = (
            values.astype(np.float32)
            for values in (
                beyond / blur.ends,
                half / in_noise,
                left / in_noise,
                share * blur.reading / blur.ends,
                _nodes,
                _weights,
            )
        )
        true = place[..., None] - reading[..., None] * nodes
        off = step[..., None] * np.tanh(true) - angle[..., None]
        return np.asarray(np.exp(-off * off) @ weights / (np.sqrt(np.pi) * in_noise))

    def _behind_softest_ends(
        self, beyond: np.ndarray, left: np.ndarray, half: np.ndarray, blur: Blur
    ) -> np.ndarray:
        """The same where the ends are straight within the reading's noise, which then is one of the angle."""
        share = np.tanh(beyond / blur.ends)
        of_torque = half * (1 - share**2) * blur.reading / blur.ends
        std = np.hypot(self._beside_soft_ends(share, half), of_torque)
        return _normal(left - half * share, std)

    def _beside_soft_ends(self, share: np.ndarray, half: np.ndarray) -> np.ndarray:
        """Deviation [arcsec] of a row's angle from that `share` (−1 … 1) of half its gap."""
        return np.asarray(np.hypot(self.noise_arcsec, FORM_DOUBT * half * (1 - share**2)))

    def _near(self, mean: np.ndarray, left: np.ndarray) -> np.ndarray:
        """Normal density of angles about a mean."""
        return _normal(left - mean, self.noise_arcsec)

    def _log(self, own: np.ndarray, gap: np.ndarray, outlying: np.ndarray) -> np.ndarray:
        """A row that the model does not claim lies anywhere over twice its gap."""
        other = outlying / (2 * gap + SPIKE_REACH * self.noise_arcsec)
        return np.asarray(np.log((1 - outlying) * own + other))


def _normal(off: np.ndarray, std: np.ndarray | float) -> np.ndarray:
    """Normal density of what lies so far off its mean."""
    return np.asarray(np.exp(-((off / std) ** 2) / 2) / (np.sqrt(2 * np.pi) * std))
