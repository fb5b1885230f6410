"""FE results of all specimens: their compliances, the load zone's share, and the sensitivities.

Changes with a dimension and with the load zone always come from the hole-free model of the same meridian.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from flexspline.geometry.design import Design
from flexspline.geometry.part_name import PartName
from flexspline.pipeline.diagnosis.measurement.record import PARTS_IN_ROW
from flexspline.pipeline.diagnosis.specimens.bench import Bench
from flexspline.pipeline.diagnosis.specimens.sensitivity import (
    Sensitivity,
    drawn_through,
    sensitivities,
)


@dataclass(frozen=True)
class Compliances:
    """FE of all specimens; compliances (n,) in rad per N·m, 0 where the part is not in the row.

    Attributes
    ----------
    flexspline, shaft : of each row's parts, load case as in the sum.
    lobes_share : (n,) (C_lobes − C_uniform)/C of the flexspline, C that of the sum's load case.
    base_zone : load zone that the simulation assumes: 0 uniform, 1 lobes.
    """

    flexspline: np.ndarray
    shaft: np.ndarray
    lobes_share: np.ndarray
    base_zone: float
    sensitivities: tuple[Sensitivity, ...]
    designs: tuple[Design, ...]

    @property
    def total(self) -> np.ndarray:
        """(n,) rad per N·m."""
        return self.flexspline + self.shaft

    def rows(self, chosen: np.ndarray) -> Compliances:
        """Some of the specimens."""
        return Compliances(
            self.flexspline[chosen], self.shaft[chosen], self.lobes_share[chosen], self.base_zone,
            tuple(s.rows(chosen) for s in self.sensitivities),
            tuple(d for d, c in zip(self.designs, chosen, strict=True) if c),
        )  # fmt: skip


def compliances(
    bench: Bench,
    designs: Sequence[Design],
    parts: Sequence[str],
    keys: Collection[str] | None = None,
    zones: bool = True,
) -> Compliances:
    """FE of all rows; `parts` as in the file. Equal designs are solved once.

    `keys` limits the dimensions whose sensitivity is wanted; `zones`: whether the load zone's is.
    """
    known: dict[tuple[str, str], float] = {}

    def once(what: str, design: Design, part: PartName) -> float:
        key = (what, design.model_dump_json() + part)
        if key not in known:
            lobed = what == "lobes"
            known[key] = (
                bench.compliance(design, part)
                if what == "own"
                else bench.plain(design, part, lobed)
            )
        return known[key]

    n = len(designs)
    own = {p: np.zeros(n) for p in PARTS_IN_ROW["series"]}
    zone = np.zeros(n)
    base = 1.0 if bench.context.design.solver.sum_at_lobes else 0.0
    for i, (design, part) in enumerate(zip(designs, parts, strict=True)):
        if n > 1:
            bench.context.progress.note(f"stiffness of specimen {i + 1} of {n}")
        for p in PARTS_IN_ROW[part]:
            own[p][i] = once("own", design, p)
        if zones and own["flexspline"][i]:
            uniform, lobes = (
                once("plain", design, "flexspline"),
                once("lobes", design, "flexspline"),
            )
            zone[i] = (lobes - uniform) / (lobes if base else uniform)
    return Compliances(
        own["flexspline"], own["shaft"], zone, base,
        tuple(s for p in own for s in sensitivities(bench, designs, own[p] > 0, p, keys)),
        tuple(designs),
    )  # fmt: skip


def refined(bench: Bench, fe: Compliances, key: str, off_mm: float) -> Compliances:
    """With the curve of one dimension drawn through FE at the deviation that was found."""
    changed = (
        drawn_through(s, bench, fe.designs, off_mm) if s.key == key else s for s in fe.sensitivities
    )
    return replace(fe, sensitivities=tuple(changed))
