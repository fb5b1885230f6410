"""Errors of models and solves; each error contains its numbers."""

from __future__ import annotations

from flexspline.geometry.errors import ComputationError


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


class MesherTimeError(MesherError):
    """The mesher met its time limit: a faster or idler machine may finish."""


class MeshQualityError(SolidError):
    """The mesh does not describe the part: a patch, a volume or an element is wrong."""


class SolveError(SolidError):
    """The linear solve did not meet its checks (residual, balance)."""


class TooManyElementsError(SolidError):
    """The mesh would have so many `elements`, or more, and at most `most` were wanted."""

    def __init__(self, elements: float, most: float) -> None:
        self.elements, self.most = elements, most
        super().__init__(
            f"the mesh would have {elements:.0f} elements or more, and none of more than {most:.0f} is made;"
            " a longer solver.edge_length_mm makes fewer"
        )


class IterationError(SolveError):
    """The iteration stopped short: `steps` taken, the error's energy `left`, the one `wanted` [N·mm]."""

    def __init__(self, steps: int, left: float, wanted: float) -> None:
        self.steps, self.left, self.wanted = steps, left, wanted
        super().__init__(
            f"{steps} steps of the iteration left an error with an energy of {left:.1e} N·mm, wanted"
            f" {wanted:.0e}: the elements may be too flat, or part of the model unsupported"
        )


class MemoryShortError(SolveError):
    """No solver fits: `unknowns`, `needed_bytes` by the thriftiest, `available_bytes`."""

    def __init__(self, unknowns: int, needed_bytes: float, available_bytes: float) -> None:
        self.unknowns = unknowns
        self.needed_bytes, self.available_bytes = needed_bytes, available_bytes
        super().__init__(
            f"{unknowns} unknowns need {needed_bytes / 2**30:.1f} GB of memory and there are"
            f" {available_bytes / 2**30:.1f} GB: raise solver.tolerance_pct or solver.edge_length_mm"
        )
