"""What `import flexspline` offers of results: `predict`, which says in words what its reader should know."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from flexspline.results.diagnosis.predicted import PredictedWithWarnings


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
    from flexspline.pipeline.diagnosis.model.model_file import read_model_file
    from flexspline.pipeline.diagnosis.model.predict import predict_file
    from flexspline.results.diagnosis.predicted import PredictedWithWarnings

    found = predict_file(read_model_file(Path(model)), Path(path), counts_per_turn)
    return PredictedWithWarnings(**vars(found))
