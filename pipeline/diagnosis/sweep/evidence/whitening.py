"""A record's rows made as if their noise were white: that of the rows, and what a way's few numbers doubt."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csr_array

from flexspline.pipeline.diagnosis.causes.cause import FitContext
from flexspline.pipeline.diagnosis.measurement.known_ways import known_ways
from flexspline.pipeline.diagnosis.measurement.noise import Noise, Whitener, stretches_of
from flexspline.pipeline.diagnosis.measurement.torque_jitter import reading_of

MOST_ROWS = 4000
"""Most whitened rows. More are summed in blocks, which is linear and distorts nothing."""


@dataclass(frozen=True)
class Whitening:
    """Of the kept rows (n,) of a rig's record, whose angle has this noise."""

    rig: FitContext
    kept: np.ndarray
    noise: Noise

    @property
    def block(self) -> int:
        """Rows that are summed to one."""
        return max(1, int(self.kept.sum()) // MOST_ROWS)

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """(n, k) columns of the record as (r, k), of noise that is independent with variance 1."""
        white = self._rows(values[self.kept].astype(float))
        if self._ways is not None:
            directions, less = self._ways
            white -= directions @ (less[:, None] * (directions.T @ white))
        if self.block == 1:
            return white
        n = len(white) // self.block * self.block
        return white[:n].reshape(-1, self.block, white.shape[1]).sum(axis=1) / np.sqrt(self.block)

    @cached_property
    def _rows(self) -> Whitener:
        """Of the kept rows, but for what the noise of the torque does to whole ways."""
        return self.noise.whitener(stretches_of(self.rig.history, self.kept))

    @cached_property
    def _ways(self) -> tuple[csr_array, np.ndarray] | None:
        """Directions (m, d) of all ways whose torque few numbers tell, and what goes of each (d,).

        The numbers' doubts are noise of whole ways, whatever noise the rows have. No row is of two ways.
        """
        history = self.rig.history
        ways = known_ways(reading_of(history))
        if not ways:
            return None
        doubts = np.zeros((len(history), max(w.doubt_Nm.shape[1] for w in ways)))
        for way in ways:
            doubts[way.rows, : way.doubt_Nm.shape[1]] = way.doubt_Nm
        white = self._rows(self.rig.prediction.compliance * doubts[self.kept])
        place = np.cumsum(self.kept) - 1
        count = 0
        values, at, numbers, sizes = (list[np.ndarray]() for _ in range(4))
        for way in ways:
            rows = place[way.rows[self.kept[way.rows]]]
            own = white[rows, : way.doubt_Nm.shape[1]]
            directions, size, _ = np.linalg.svd(own, full_matrices=False)
            values.append(directions.ravel())
            at.append(np.repeat(rows, len(size)))
            numbers.append(np.tile(count + np.arange(len(size)), len(rows)))
            sizes.append(size)
            count += len(size)
        entries = np.concatenate(values), (np.concatenate(at), np.concatenate(numbers))
        whole = coo_array(entries, shape=(len(white), count))
        return csr_array(whole), 1 - 1 / np.hypot(1, np.concatenate(sizes))
