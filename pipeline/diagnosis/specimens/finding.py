"""What is found in specimens, with all that a figure or a report needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

if TYPE_CHECKING:  # they load the solvers
    from flexspline.pipeline.diagnosis.specimens.evidence import LaplaceFit
    from flexspline.pipeline.diagnosis.specimens.race import SpecimenRace

GuessedBy = Literal["overridden_keys", "stiffness"] | None
"""What says which part a specimen is, where its file does not."""


@dataclass(frozen=True)
class SpecimenAnalysis:
    """Measured against FE, specimen by specimen.

    Attributes
    ----------
    specimen, part : of each row; the part as decided where the file does not say.
    measured, simulated, calibrated, explained : (n,) stiffness [N·m/rad]: as measured, of FE, of FE with
        Young's modulus within its uncertainty, and of the chosen explanation.
    noise : (n,) relative standard deviation of one stiffness, solver's share included.
    held_out : (n,) relative error of each specimen's stiffness, predicted from the others by the chosen
        explanation; `held_out_before` by FE as it is. NaN where nothing was held out.
    race : all fits and the null; chosen : the one that the verdict speaks of.
    with_holes : whether rows were solved with their holes, not scaled from given stiffnesses.
    part_guessed_by : what says the part, where the file does not.
    """

    specimen: tuple[str, ...]
    part: tuple[str, ...]
    measured: np.ndarray
    simulated: np.ndarray
    calibrated: np.ndarray
    explained: np.ndarray
    noise: np.ndarray
    held_out: np.ndarray
    held_out_before: np.ndarray
    race: SpecimenRace
    chosen: LaplaceFit
    with_holes: bool
    part_guessed_by: GuessedBy
