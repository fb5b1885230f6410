"""Which figures a diagnosis has; one place that tells kinds of measurement apart."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis
from flexspline.pipeline.diagnosis.measurement.record import Specimens, Sweep
from flexspline.pipeline.diagnosis.outcome import Gain, Unexplained
from flexspline.pipeline.diagnosis.specimens.finding import SpecimenAnalysis
from flexspline.pipeline.diagnosis.sweep.residual_tests import STRUCTURE_P_VALUE, ChannelTest
from flexspline.results.diagnosis.channels import channel_words
from flexspline.results.figures.diagnosis.captions import caption
from flexspline.results.figures.diagnosis.contribution_parts import parts
from flexspline.results.figures.diagnosis.contributions import write_contributions
from flexspline.results.figures.diagnosis.end_points import (
    write_envelope,
    write_positions,
)
from flexspline.results.figures.diagnosis.held_out import write_held_out
from flexspline.results.figures.diagnosis.overview import write_overview
from flexspline.results.figures.diagnosis.panels import write_channels
from flexspline.results.figures.diagnosis.rivals import write_rivals
from flexspline.results.figures.diagnosis.seen import SweepPictureData, seen
from flexspline.results.figures.diagnosis.specimens import (
    write_dimensions,
    write_held_out_specimens,
    write_stiffness,
)
from flexspline.results.figures.diagnosis.units import shared_causes, write_units


@dataclass(frozen=True)
class DiagnosisFigure:
    """A figure: its file, and a caption that says what to see."""

    path: Path
    caption: str


class _Sheet:
    """Figures drawn so far, and where the next one goes."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.drawn: list[DiagnosisFigure] = []

    def place(self, name: str, words: str | None = None) -> Path:
        path = self.folder / f"{name}.png"
        self.drawn.append(DiagnosisFigure(path, words or caption(name)))
        return path


def draw_figures(diagnosis: Diagnosis, folder: Path) -> list[DiagnosisFigure]:
    """Draw every figure that has something to show into `folder`."""
    sheet = _Sheet(folder)
    measurement = diagnosis.measurement
    if isinstance(measurement, Sweep):
        shown = seen(diagnosis)
        if shown is not None:
            _sweep(shown, sheet)
    elif diagnosis.end_points is not None:
        _end_points(diagnosis.end_points, sheet)
    elif isinstance(measurement, Specimens) and diagnosis.specimens is not None:
        _specimens(diagnosis.specimens, diagnosis.outcome.gain, measurement.overrides, sheet)
    return sheet.drawn


def _sweep(shown: SweepPictureData, sheet: _Sheet) -> None:
    outcome = shown.diagnosis.outcome
    write_overview(sheet.place("measured_and_predicted"), shown)
    write_channels(
        sheet.place("residual_simulation"),
        shown,
        shown.calibrated,
        "Residual of the simulation against every channel",
    )
    if parts(shown):
        write_contributions(sheet.place("causes"), shown)
    shares = shared_causes(shown)
    if shares:
        write_units(sheet.place("units"), shown, shares)
    gain = outcome.gain
    if gain is not None and gain.left and outcome.causes:
        write_held_out(sheet.place("held_out"), gain)
    words = None
    if outcome.unexplained:
        channels = dict.fromkeys(channel_words(u.channel) for u in outcome.unexplained)
        words = caption("residual_unknown", where=", ".join(channels))
    write_channels(
        sheet.place("residual_model", words),
        shown,
        shown.left,
        "Residual of the best model against every channel",
        residual_words(shown.tests, outcome.unexplained),
    )


def residual_words(
    tests: Iterable[ChannelTest], unexplained: Sequence[Unexplained]
) -> dict[str, str]:
    """Of each channel, whether structure is left in it; the best model holds what has no name too."""
    nameless = {u.channel: u.rms for u in unexplained}
    nothing = "no further structure" if nameless else "no structure left"
    said = {}
    for t in tests:
        if t.p_value < STRUCTURE_P_VALUE:
            said[t.channel] = f"structure left, {t.rms_arcsec:.2g} arcsec"
        elif t.channel in nameless:
            said[t.channel] = f"fitted without a name, {nameless[t.channel]:.2g} arcsec"
        else:
            said[t.channel] = nothing
    return said


def _end_points(analysis: EndPointAnalysis, sheet: _Sheet) -> None:
    write_envelope(sheet.place("envelope"), analysis)
    write_positions(sheet.place("positions"), analysis)
    if len(analysis.hypotheses) > 1:
        write_rivals(sheet.place("rivals"), analysis)


def _specimens(
    analysis: SpecimenAnalysis, gain: Gain | None, overrides: dict[str, np.ndarray], sheet: _Sheet
) -> None:
    write_stiffness(sheet.place("stiffness"), analysis)
    if any(np.ptp(v) > 0 for v in overrides.values()):
        write_dimensions(sheet.place("dimensions"), analysis, overrides)
    if gain is not None and analysis.chosen.terms and np.isfinite(analysis.held_out).all():
        path = sheet.place("held_out", caption("held_out_specimens"))
        write_held_out_specimens(path, analysis, gain)
