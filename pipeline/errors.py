"""Errors that stop the whole analysis of a design, because a model of the program is wrong."""

from __future__ import annotations

from flexspline.geometry.errors import FlexsplineError


class NestingError(FlexsplineError, RuntimeError):
    """Less material came out stiffer than more: one of the models is wrong.

    No ComputationError, which costs its own figure only: no figure of either model is to be trusted, so it
    ends whatever was asked of the design. The other designs of a study keep their rows.

    Attributes
    ----------
    softer_Nm_per_rad : least K of the body that has less material.
    stiffer_Nm_per_rad : largest K of the one that has more.
    """

    def __init__(self, less: str, softer: float, more: str, stiffer: float) -> None:
        self.softer_Nm_per_rad, self.stiffer_Nm_per_rad = softer, stiffer
        super().__init__(
            f"{less} is at least {softer:.7g} N·m/rad stiff, {more}, which has more material, at most "
            f"{stiffer:.7g}: one of the two solutions is wrong; please report the design file"
        )
