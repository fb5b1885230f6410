"""A prediction with its warnings, in words."""

from __future__ import annotations

from dataclasses import dataclass

from flexspline.pipeline.diagnosis.model.predict import Predicted
from flexspline.results.diagnosis.prediction_words import prediction_warnings


@dataclass(frozen=True)
class PredictedWithWarnings(Predicted):
    """What a model says of a history; `warnings`: what the command prints beside it."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """Units that the model's record does not have, and rows outside of what it spans: one line each."""
        return tuple(prediction_warnings(self))
