"""Notes on stiffnesses of specimens, one line each."""

from __future__ import annotations

from flexspline.pipeline.diagnosis.specimens.cause_ids import YOUNGS_MODULUS
from flexspline.pipeline.diagnosis.specimens.finding import SpecimenAnalysis
from flexspline.results.diagnosis.tolerance_words import modulus_alone, within_tolerance
from flexspline.results.diagnosis.words import plus_minus

GUESSED_BY = {"overridden_keys": "the overridden keys", "stiffness": "its stiffness"}
"""What says which part a specimen is."""


def specimen_notes(analysis: SpecimenAnalysis) -> list[str]:
    """The noise, the part, the modulus, dimensions within their tolerance, and how specimens were solved."""
    chosen = analysis.chosen
    noise = f"the noise of one stiffness is taken as {100 * float(chosen.noise.mean()):.2g} %"
    if analysis.race.data.std is None:
        noise += ", estimated from the scatter, because the file states none"
    lines = [noise]
    if analysis.part_guessed_by is not None:
        part = analysis.part[0]
        lines.insert(
            0,
            f"the file has no column part: the part is taken as {part} because of "
            f"{GUESSED_BY[analysis.part_guessed_by]}",
        )
    if YOUNGS_MODULUS not in chosen.causes:
        change = plus_minus(100 * chosen.mean[0], 100 * float(chosen.covariance[0, 0] ** 0.5))
        dimensions = within_tolerance(analysis)
        beside = f", beside {dimensions[0][0].key}" if dimensions else ""
        lines.append(f"Young's modulus calibrated by {change} % within its uncertainty{beside}")
    for s, value in within_tolerance(analysis):
        change = f"{value:+.2g}".replace("-", "−")
        lines.append(
            f"{s.key} {change} mm would fit the data; this is within ± {s.tolerance_mm:g} mm (ISO "
            "2768-m) and therefore not a finding"
        )
    if alone := modulus_alone(analysis):
        lines.append(alone)
    how = (
        "solved with its holes"
        if analysis.with_holes
        else "the given stiffness times a ratio of the model without holes"
    )
    lines.append(
        f"the simulated stiffness of each specimen is {how}; sensitivities to dimensions come from the model "
        "without holes"
    )
    return lines
