"""What can go wrong in a solid model; each error carries its numbers."""

from __future__ import annotations

from geometry.errors import ComputationError


class SolidError(ComputationError):
    """A solid model could not be built or solved."""


class MesherError(SolidError):
    """The tetrahedral mesher failed, hung or crashed.

    Attributes
    ----------
    reason : what happened.
    advice : what to try.
    """

    def __init__(self, reason: str, advice: str) -> None:
        self.reason, self.advice = reason, advice
        super().__init__(f"{reason}; {advice}")


class MeshQualityError(SolidError):
    """The mesh does not describe the part: a patch, a volume or an element is wrong."""


class SolveError(SolidError):
    """The linear solve did not meet its checks (residual, balance)."""
