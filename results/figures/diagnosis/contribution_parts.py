"""Parts of the extended model that a figure shows: channel, axes and words of each."""

from __future__ import annotations

from dataclasses import dataclass

from flexspline.pipeline.diagnosis.causes import known_causes
from flexspline.pipeline.diagnosis.causes.cause import Effect
from flexspline.pipeline.diagnosis.causes.friction_hysteresis import FRICTION
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.results.diagnosis.channels import channel_words
from flexspline.results.diagnosis.words import (
    WIDE,
    cause_title,
    factor_words,
    magnitude_words,
    odds_words,
    sure_words,
    title_of,
)
from flexspline.results.figures.diagnosis.seen import PlotChannel, SweepPictureData
from flexspline.results.numbers import figures_text
from flexspline.results.sentences import capital

SHORT = 55
"""Letters of a title that fit above a panel; of a longer one, what stands in brackets is left out."""
LEAST_SHOWN = 1 / 3
"""Of the noise: a part without a name that is smaller than this cannot be seen in its panel."""


@dataclass(frozen=True)
class ContributionPanel:
    """A panel: an owner of terms, and the words beside it."""

    owner: str
    title: str
    lines: tuple[str, ...]
    channel: PlotChannel
    view: Effect = "angle"


def parts(shown: SweepPictureData) -> list[ContributionPanel]:
    """Named causes, then structure that has no name."""
    identified = shown.explained.identified
    panels = [_named(shown, c) for c in shown.analysis.causes]
    named = {p.owner for p in panels}
    for owner, rms in sorted(identified.rms.items(), key=lambda item: -item[1]):
        if owner in named or rms < LEAST_SHOWN * shown.noise_arcsec:
            continue
        trace = rms < shown.noise_arcsec
        title, lines = _unnamed(shown.channel_name(owner.removeprefix("?")), owner, rms, trace)
        panels.append(ContributionPanel(owner, title, lines, shown.channel(_channel_of(owner))))
    return panels


def _unnamed(
    channel: str, owner: str, rms_arcsec: float, trace: bool
) -> tuple[str, tuple[str, ...]]:
    """Title and lines of structure, or of a cause that the model holds and the verdict does not name.

    What is more than a `trace`, which noise hides, is not named for a reason that the verdict gives.
    """
    size = f"{figures_text(rms_arcsec, 2)} arcsec rms"
    if owner in known_causes():
        why = ["smaller than the noise:", "too little to name"]
        if not trace:
            why = ["it fits these rows;", "the verdict says why", "it is not named"]
        return _short(f"Not named: {title_of(owner)}"), (size, *why)
    words = channel_words(channel)
    lines = (size, f"varies with: {words}", "no known cause explains it")
    return f"Unexplained: structure in {words}", lines


def _channel_of(owner: str) -> str:
    """Where a minor cause shows best; structure in a channel shows over it, that of units over torque."""
    if owner in known_causes():
        return known_causes()[owner].shows_over
    return "torque_Nm" if owner == "?unit" else owner.removeprefix("?")


def _named(shown: SweepPictureData, cause: NamedCause) -> ContributionPanel:
    known = known_causes()[cause.id]
    channel = shown.channel(known.shows_over)
    # lines of their own: there is no room beside the number
    beside = factor_words(cause) or (WIDE.strip() if cause.id == FRICTION else "")
    lines = [
        magnitude_words(cause).removesuffix(f" {beside}"),
        *([beside] if beside else []),
        f"{figures_text(cause.rms_arcsec, 2)} arcsec rms of the angle",
        f"{sure_words(cause)}:",
        odds_words(cause.evidence_nats),
    ]
    if cause.alternatives:
        lines[-2:] = ["not decided: other causes", "explain it equally well"]
    return ContributionPanel(
        cause.id,
        _short(cause_title(cause)),
        tuple(lines),
        channel,
        known.shows_as if channel.key == known.shows_over else "angle",
    )


def _short(title: str) -> str:
    return capital(title if len(title) <= SHORT else title.partition(" (")[0])
