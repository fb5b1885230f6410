"""`flexspline.predict`: a prediction with what its reader should know, in words."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from flexspline.pipeline.diagnosis.model.model_file import read_model_file
from flexspline.pipeline.diagnosis.model.predict import Predicted, predict_file
from flexspline.results.diagnosis.prediction_words import prediction_warnings


@dataclass(frozen=True)
class PredictedWithWarnings(Predicted):
    """What a model says of a history; `warnings`: what the command prints beside it."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """Units that the model's record does not have, and rows outside of what it spans: one line each."""
        return tuple(prediction_warnings(self))


def predict(
    model: Path | str, path: Path | str, *, counts_per_turn: float | None = None
) -> PredictedWithWarnings:
    """The angle for each row of a measured file, by an `extended_model.toml` that `diagnose` wrote.

    Parameters
    ----------
    counts_per_turn : of the encoder, where the file's wave-generator angle is in counts.

    Raises
    ------
    ModelFileError, MeasurementError

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from flexspline import FlexsplineError, predict
    >>> try:
    ...     predict("no-such-model.toml", "examples/measured/xb1-40-sweep.csv")
    ... except FlexsplineError as fault:
    ...     print(fault)
    no-such-model.toml: no such file
    """
    found = predict_file(read_model_file(Path(model)), Path(path), counts_per_turn)
    return PredictedWithWarnings(**vars(found))
