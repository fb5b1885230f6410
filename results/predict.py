"""The Python function `predict`, with its warnings in words."""

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
    A model without causes, as `diagnose` writes it: 10 arcsec per N·m and a gap of 60 arcsec give
    ±(10 + 60/2) arcsec at ±1 N·m.

    >>> import tempfile
    >>> from pathlib import Path
    >>> from flexspline import predict
    >>> written = '''
    ... format = 1
    ... [provenance]
    ... program = "flexspline 0.1.0"
    ... design = "XB1-40 cup"
    ... measurement = "sweep.csv"
    ... measurement_sha256 = ""
    ... verdict = "consistent"
    ... K_b_Nm_per_rad = 31312.0
    ... K_e_Nm_per_rad = 43275.0
    ... time_recorded = false
    ... [calibrated]
    ... compliance_arcsec_per_Nm = 10.0
    ... gap_arcsec = 60.0
    ... [[unit]]
    ... name = ""
    ... zero_arcsec = 0.0
    ... '''
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     model, history = Path(folder, "extended_model.toml"), Path(folder, "history.csv")
    ...     _ = model.write_text(written, encoding="utf-8")
    ...     _ = history.write_text("torque_Nm\\n1\\n-1\\n", encoding="utf-8")
    ...     predicted = predict(model, history)
    >>> predicted.angle_arcsec.tolist()
    [40.0, -40.0]
    """
    from flexspline.geometry.input_file import file_name
    from flexspline.pipeline.diagnosis.model.model_file import read_model_file
    from flexspline.pipeline.diagnosis.model.predict import predict_file
    from flexspline.results.diagnosis.predicted import PredictedWithWarnings

    read = read_model_file(file_name(model, "model"))
    predicted = predict_file(read, file_name(path, "measured data"), counts_per_turn)
    return PredictedWithWarnings(**vars(predicted))
