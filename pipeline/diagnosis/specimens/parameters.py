"""Hypotheses about specimens: each one more parameter of the compliance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from flexspline.pipeline.diagnosis.causes.series_compliance import SERIES
from flexspline.pipeline.diagnosis.specimens.cause_ids import GEOMETRY, LOAD_ZONE, YOUNGS_MODULUS
from flexspline.pipeline.diagnosis.specimens.compliances import Compliances
from flexspline.pipeline.diagnosis.specimens.sensitivity import Sensitivity
from flexspline.pipeline.diagnosis.structure import UnnamedForm

MODULUS_SPREAD = 0.1
"""Standard deviation of ln E if the material is not the stated one. Judgement."""
SERIES_SPREAD = 0.3
"""Standard deviation of an added compliance over the median specimen's compliance. Judgement."""
ZONES = ((1.0, 0.12, 0.35), (0.5, 0.35, 0.15))
"""Prior mean, standard deviation and odds of the load zone: where the simulation spreads the torque
evenly, a real wave generator mostly takes it at its lobes, or part of the way."""
LEAST_LOBES_SHARE = 0.01
"""Of the flexspline's compliance: where the zone changes less, it cannot be told, as rigs repeat to 1 %."""
WRONG_TOLERANCES = 3.0
"""A dimension that is wrong is off by some general tolerances: the standard deviation of how many. Judgement:
six times as wide as one that is right, so that what is beyond the tolerance is mostly wrong."""
TOLERANCE_SHARE = 0.5
"""A dimension that is right is off by some half of its tolerance, which is then two deviations: 95 % of parts
are within."""
MOST_TOLERANCES = 8.0
"""Beyond, it would be another drawing: of wrong dimensions, by WRONG_TOLERANCES, one in 130."""
UNNAMED_STRUCTURE_SPREAD = 0.07
"""Standard deviation of ln K [1] for structure without a name, taken: seven times what rigs repeat to, so
that whatever stands out of the noise fits."""
CAUSE_KINDS = 4
"""Modulus, dimension, fixture, load zone: even odds."""
LEAST_rad_per_Nm = 1e-30
"""Smallest compliance of a specimen whose logarithm is taken. All smaller ones fit equally badly."""
UNNAMED_STRUCTURE_NATS = -3.0
"""Log prior odds of all structure without a name, 1 in 20: a fifth of one of CAUSE_KINDS."""


@dataclass(frozen=True)
class SpecimenParameter:
    """One parameter.

    Attributes
    ----------
    owner : the id of the cause (docs/contract.md), or "?" and a channel.
    kind : "modulus", "series", "zone", "geometry" or "column".
    spread, centre : prior standard deviation and mean of the parameter.
    positive : whether it cannot be below 0. odds : log prior probability. form : of columns.
    parts : parts whose modulus changes. sensitivity, column : where the kind needs them.
    within : a dimension within its tolerance, which is no finding.
    """

    owner: str
    kind: str
    spread: float
    odds: float
    positive: bool = False
    form: UnnamedForm | None = None
    parts: tuple[str, ...] = ()
    sensitivity: Sensitivity | None = None
    column: np.ndarray | None = None
    within: bool = False
    centre: float = 0.0

    def rows(self, chosen: np.ndarray) -> SpecimenParameter:
        """For some of the specimens."""
        s = self.sensitivity
        return replace(
            self,
            column=None if self.column is None else self.column[chosen],
            sensitivity=None if s is None else s.rows(chosen),
        )

    @property
    def named(self) -> bool:
        """Whether it is a finding with a name."""
        return not self.owner.startswith("?") and not self.within


def specimen_parameters(
    fe: Compliances, overrides: Mapping[str, np.ndarray], one_material: bool
) -> list[SpecimenParameter]:
    """All hypotheses for some specimens."""
    even = -float(np.log(CAUSE_KINDS))
    parameters = [
        SpecimenParameter(SERIES, "series", SERIES_SPREAD * float(np.median(fe.total)), even, True)
    ]
    parts = tuple(p for p, c in (("flexspline", fe.flexspline), ("shaft", fe.shaft)) if c.any())
    groups = [parts] if one_material or len(parts) == 1 else [parts, ("flexspline",), ("shaft",)]
    parameters += [
        SpecimenParameter(
            YOUNGS_MODULUS, "modulus", MODULUS_SPREAD, even - float(np.log(len(groups))), parts=g
        )
        for g in groups
    ]
    if (np.abs(fe.lobes_share) > LEAST_LOBES_SHARE).any():
        side = -1.0 if fe.base_zone else 1.0
        parameters += [
            SpecimenParameter(
                LOAD_ZONE, "zone", spread, even + float(np.log(weight)), centre=side * centre
            )
            for centre, spread, weight in ZONES
        ]
    each = -0.5 * float(np.log(max(len(fe.sensitivities), 1)))
    for s in fe.sensitivities:
        for factor, within in ((WRONG_TOLERANCES, False), (TOLERANCE_SHARE, True)):
            parameters.append(SpecimenParameter(
                GEOMETRY + s.key, "geometry", factor * s.tolerance_mm, even + each,
                sensitivity=s, within=within,
            ))  # fmt: skip
    return parameters + _columns(len(fe.total), overrides)


def _columns(n: int, overrides: Mapping[str, np.ndarray]) -> list[SpecimenParameter]:
    """Structure without a name: over the order of specimens, over each dimension, one specimen's own."""
    order = np.linspace(-1, 1, n)
    shapes: list[tuple[str, UnnamedForm, np.ndarray]] = [
        ("?specimen_order", UnnamedForm("trend"), order),
        ("?specimen_order", UnnamedForm("bend"), order**2 - (order**2).mean()),
        ("?specimen_order", UnnamedForm("alternating"), np.cos(np.pi * np.arange(n))),
        ("?specimen_order", UnnamedForm("half_step"), np.sign(order)),
    ]
    for key, values in overrides.items():
        if np.ptp(values) > 0:
            x = (values - values.mean()) / np.abs(values - values.mean()).max()
            bend = x**2 - (x**2).mean()
            slope = (x @ bend) / (x @ x)
            shapes += [
                (f"?{key}", UnnamedForm("trend"), x),
                (f"?{key}", UnnamedForm("bend"), bend - slope * x),
            ]
    shapes += [
        ("?specimen", UnnamedForm("one_specimen", i + 1), (np.arange(n) == i).astype(float))
        for i in range(n)
    ]
    odds = UNNAMED_STRUCTURE_NATS - float(np.log(len(shapes)))
    return [
        SpecimenParameter(owner, "column", UNNAMED_STRUCTURE_SPREAD, odds, form=form, column=column)
        for owner, form, column in shapes
    ]


def log_compliance(
    fe: Compliances, terms: Sequence[SpecimenParameter], at: np.ndarray
) -> np.ndarray:
    """(n,) ln C [ln(rad per N·m)]; `at` (1 + len(terms),): ln E of all parts, then the terms' values.

    C = C_b·q_b·(1 + zone)/E_b + C_e·q_e/E_e + series, q from dimensions.
    """
    rim = np.full(len(fe.total), -at[0])
    shaft = rim.copy()
    added, column = np.zeros(len(rim)), np.zeros(len(rim))
    for term, value in zip(terms, at[1:], strict=True):
        match term.kind:
            case "modulus":
                rim = rim - value * ("flexspline" in term.parts)
                shaft = shaft - value * ("shaft" in term.parts)
            case "series":
                added = added + value
            case "zone":
                rim = rim + np.log(np.maximum(1 + value * fe.lobes_share, 1e-3))
            case "geometry":
                assert term.sensitivity is not None
                change = term.sensitivity.log_change(float(value))
                if term.sensitivity.part == "shaft":
                    shaft = shaft + change
                else:
                    rim = rim + change
            case _:
                assert term.column is not None
                column = column - value * term.column
    total = fe.flexspline * np.exp(rim) + fe.shaft * np.exp(shaft) + added
    return np.log(np.maximum(total, LEAST_rad_per_Nm)) + column
