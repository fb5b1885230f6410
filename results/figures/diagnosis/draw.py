"""Selects the figures of a diagnosis by its kind of measurement."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.end_points.finding import EndPointAnalysis
from flexspline.pipeline.diagnosis.measurement.record import Specimens, Sweep
from flexspline.pipeline.diagnosis.outcome import Gain, Unexplained
from flexspline.pipeline.diagnosis.specimens.finding import SpecimenAnalysis
from flexspline.pipeline.diagnosis.sweep.residual.residual_tests import (
    STRUCTURE_P_VALUE,
    ChannelTest,
)
from flexspline.pipeline.second_process import results_of
from flexspline.results.diagnosis.channels import channel_words
from flexspline.results.figures.diagnosis.captions import LOOP_WIDTH, caption
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
from flexspline.results.figures.diagnosis.unit_shares import shared_causes, write_units
from flexspline.results.numbers import figures_text


@dataclass(frozen=True)
class DiagnosisFigure:
    """A figure: its file, and a caption that says what to see."""

    path: Path
    caption: str


class _FigureList:
    """Figures in their order, and how each is drawn."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.figures: list[DiagnosisFigure] = []
        self.drawings: list[Callable[[], None]] = []

    def add(self, name: str, write: Callable[[Path], None], words: str | None = None) -> None:
        """A figure that `write` draws into its file."""
        path = self.folder / f"{name}.png"
        self.figures.append(DiagnosisFigure(path, words or caption(name)))
        self.drawings.append(partial(write, path))


def draw_figures(diagnosis: Diagnosis, folder: Path) -> list[DiagnosisFigure]:
    """Draw every figure that has something to show into `folder`."""
    sheet = _FigureList(folder)
    measurement = diagnosis.measurement
    if isinstance(measurement, Sweep):
        shown = seen(diagnosis)
        if shown is not None:
            _sweep(shown, sheet)
    elif diagnosis.end_points is not None:
        _end_points(diagnosis.end_points, sheet)
    elif isinstance(measurement, Specimens) and diagnosis.specimens is not None:
        _specimens(diagnosis.specimens, diagnosis.outcome.gain, measurement.overrides, sheet)
    results_of(sheet.drawings)
    return sheet.figures


def _sweep(shown: SweepPictureData, sheet: _FigureList) -> None:
    outcome, gain = shown.diagnosis.outcome, shown.diagnosis.outcome.gain
    sheet.add("measured_and_predicted", lambda path: write_overview(path, shown))
    before = "Residual of the simulation against every channel"
    sheet.add(
        "residual_simulation", lambda path: write_channels(path, shown, shown.calibrated, before)
    )
    words = None
    if outcome.unexplained:
        channels = dict.fromkeys(channel_words(u.channel) for u in outcome.unexplained)
        words = caption("residual_unknown", where=", ".join(channels))
    after = "Residual of the best model against every channel"
    results = residual_words(shown.tests, outcome.unexplained)
    sheet.add(
        "residual_model",
        lambda path: write_channels(path, shown, shown.left, after, results),
        words,
    )
    if parts(shown):
        rubs = any(c.id == FRICTION for c in outcome.causes)
        words = caption("causes", friction=LOOP_WIDTH if rubs else "")
        sheet.add("causes", lambda path: write_contributions(path, shown), words)
    shares = shared_causes(shown)
    if shares:
        sheet.add("units", lambda path: write_units(path, shown, shares))
    if gain is not None and gain.left and outcome.causes:
        sheet.add("held_out", lambda path: write_held_out(path, gain))


def residual_words(
    tests: Iterable[ChannelTest], unexplained: Sequence[Unexplained]
) -> dict[str, str]:
    """Of each channel, whether structure is left in it; the best model holds what has no name too."""
    nameless = {u.channel: u.rms for u in unexplained}
    nothing = "no further structure" if nameless else "no structure left"
    results = {}
    for t in tests:
        if t.p_value < STRUCTURE_P_VALUE:
            results[t.channel] = f"structure left, {figures_text(t.rms_arcsec, 2)} arcsec"
        elif t.channel in nameless:
            results[t.channel] = (
                f"fitted, no cause known, {figures_text(nameless[t.channel], 2)} arcsec"
            )
        else:
            results[t.channel] = nothing
    return results


def _end_points(analysis: EndPointAnalysis, sheet: _FigureList) -> None:
    sheet.add("envelope", lambda path: write_envelope(path, analysis))
    sheet.add("positions", lambda path: write_positions(path, analysis))
    if len(analysis.hypotheses) > 1:
        sheet.add("rivals", lambda path: write_rivals(path, analysis))


def _specimens(
    analysis: SpecimenAnalysis,
    gain: Gain | None,
    overrides: dict[str, np.ndarray],
    sheet: _FigureList,
) -> None:
    sheet.add("stiffness", lambda path: write_stiffness(path, analysis))
    if any(np.ptp(v) > 0 for v in overrides.values()):
        sheet.add("dimensions", lambda path: write_dimensions(path, analysis, overrides))
    if gain is not None and analysis.chosen.terms and np.isfinite(analysis.held_out).all():
        words = caption("held_out_specimens")
        sheet.add("held_out", lambda path: write_held_out_specimens(path, analysis, gain), words)
