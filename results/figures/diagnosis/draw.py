"""Which figures a diagnosis has; one place that tells kinds of measurement apart."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pipeline.diagnosis.diagnose import Diagnosis
from pipeline.diagnosis.end_points.finding import EndPointAnalysis
from pipeline.diagnosis.leftover import channel_tests
from pipeline.diagnosis.record import Specimens, Sweep
from pipeline.diagnosis.specimens.finding import SpecimenAnalysis
from results.diagnosis.words import channel_words
from results.figures.diagnosis.contributions import parts, write_contributions
from results.figures.diagnosis.end_points import write_envelope, write_positions, write_rivals
from results.figures.diagnosis.held_out import write_held_out
from results.figures.diagnosis.overview import write_overview
from results.figures.diagnosis.panels import write_channels
from results.figures.diagnosis.seen import Seen, seen
from results.figures.diagnosis.specimens import (
    write_dimensions,
    write_held_out_specimens,
    write_stiffness,
)

SIGNIFICANT = 1e-4
"""p-value below which a panel says that structure is left."""


@dataclass(frozen=True)
class Drawn:
    """A figure: its file, and a caption that says what to see."""

    path: Path
    caption: str


def draw_figures(diagnosis: Diagnosis, folder: Path) -> list[Drawn]:
    """Draw every figure that has something to show into `folder`."""
    if isinstance(diagnosis.measurement, Sweep):
        shown = seen(diagnosis)
        return [] if shown is None else _sweep(shown, folder)
    if diagnosis.end_points is not None:
        return _end_points(diagnosis.end_points, folder)
    if isinstance(diagnosis.measurement, Specimens) and diagnosis.specimens is not None:
        return _specimens(diagnosis, diagnosis.specimens, diagnosis.measurement.overrides, folder)
    return []


def _end_points(analysis: EndPointAnalysis, folder: Path) -> list[Drawn]:
    found = [Drawn(folder / "envelope.png", (
        "The angle between −T and +T of each unit. The band holds 95 of 100 units that are as the design says; "
        "a unit beyond it has something that the design's clearances and stiffness do not."
    ))]  # fmt: skip
    write_envelope(found[-1].path, analysis)
    found.append(Drawn(folder / "positions.png", (
        "Where the two ends of each unit lie. The symmetric simulation puts every middle on zero; the zero of "
        "an angle reading is free, so a middle elsewhere proves nothing alone."
    )))  # fmt: skip
    write_positions(found[-1].path, analysis)
    if len(analysis.hypotheses) > 1:
        found.append(Drawn(folder / "rivals.png", (
            "Above, how the odds are shared among the explanations; bars of like length cannot be told apart. "
            "Below, where shown, what a further measurement would do about it."
        )))  # fmt: skip
        write_rivals(found[-1].path, analysis)
    return found


def _specimens(
    diagnosis: Diagnosis, analysis: SpecimenAnalysis, overrides: dict[str, np.ndarray], folder: Path
) -> list[Drawn]:
    found = [Drawn(folder / "stiffness.png", (
        "Measured stiffness of each specimen as deviation from the simulation. With the cause found, the "
        "diamonds lie on the measured points."
    ))]  # fmt: skip
    write_stiffness(found[-1].path, analysis)
    if any(np.ptp(v) > 0 for v in overrides.values()):
        found.append(Drawn(folder / "dimensions.png", (
            "The same deviation against every dimension that varies. A slope says on what the fault depends; a "
            "shift of all points alike is the material's, or a part that the simulation leaves out."
        )))  # fmt: skip
        write_dimensions(found[-1].path, analysis, overrides)
    gain = diagnosis.outcome.gain
    if gain is not None and analysis.chosen.terms and np.isfinite(analysis.held_out).all():
        found.append(Drawn(folder / "held_out.png", (
            "Each specimen predicted from all others. As far as the last bar comes down to the dashed line, the "
            "explanation predicts as well as the rig measures."
        )))  # fmt: skip
        write_held_out_specimens(found[-1].path, analysis, gain)
    return found


def _sweep(shown: Seen, folder: Path) -> list[Drawn]:
    outcome = shown.diagnosis.outcome
    found = []

    def drawn(name: str, caption: str) -> Path:
        found.append(Drawn(folder / f"{name}.png", caption))
        return folder / f"{name}.png"

    write_overview(drawn("measured_and_predicted", (
        "Above, the measured angle on the simulated line; below, their difference. A difference inside the "
        "band is what the design's own uncertainty allows; a pattern in it is not."
    )), shown)  # fmt: skip
    write_channels(
        drawn("residual_simulation", (
            "What the simulation leaves, its stiffness and gap calibrated by up to two standard deviations of "
            "the design's uncertainty, against every channel recorded. If nothing were missing, all points would lie in the "
            "grey band and the lines on zero. Lines apart for rising and falling torque mean friction or "
            "lag; lines that drift apart for T > 0 and T < 0 mean a gap or a stiffness that changes."
        )),
        shown, shown.calibrated, "What the simulation leaves, against every channel", "residual in arcsec",
    )  # fmt: skip
    if parts(shown):
        write_contributions(drawn("causes", (
            "Each part of the extended model alone. Pale: the measurement with all other parts taken off. "
            "Dark: what the model adds. The pale points should scatter evenly about the dark ones."
        )), shown)  # fmt: skip
    gain = outcome.gain
    if gain is not None and gain.left and outcome.causes:
        write_held_out(drawn("held_out", (
            "Error on rows that were kept out of the fit. As far as the last bar comes down to the dashed "
            "line, the extended model predicts as well as the instrument reads."
        )), gain)  # fmt: skip
    write_channels(
        drawn("residual_model", _left_caption(shown)),
        shown, shown.left, "What the best model leaves, against every channel", "residual in arcsec",
        _told(shown),
    )  # fmt: skip
    return found


def _told(shown: Seen) -> dict[str, str]:
    """Of each channel, whether structure is left in it."""
    return {
        t.channel: f"structure left, {t.rms_arcsec:.2g}″" if t.p_value < SIGNIFICANT else "nothing left"
        for t in channel_tests(shown.explained.prepared, shown.solution)
    }


def _left_caption(shown: Seen) -> str:
    if shown.diagnosis.outcome.verdict == "unknown":
        where = ", ".join(
            dict.fromkeys(channel_words(u.channel) for u in shown.diagnosis.outcome.unexplained)
        )
        return (
            f"What remains after the best model, unnamed structure included. The structure that no cause "
            f"explains lies in: {where}; the figure before shows its course."
        )
    return (
        "What remains after the best model: the points should fill the grey band evenly and the lines stay "
        "near zero. Each panel says whether a test finds anything left."
    )
