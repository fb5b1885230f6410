"""The report's section on the scatter of a tolerance study."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from flexspline.pipeline.study.scatter import TIGHTENING_FACTORS, Scatter
from flexspline.pipeline.study.schema import MOST_EVALUATIONS
from flexspline.results.report.document import Block, Column, Heading, Paragraph, Table
from flexspline.results.study.gains import gain_text, gains_shown, least_gain
from flexspline.results.study.labels import entry


def scatter_section(s: Scatter) -> Iterable[Block]:
    """Of one figure: its range, where the shares come from, and a table over the inputs."""
    q = entry(s.key)
    sentence = (
        f"{q.name}: mean {q.with_unit(s.mean)}, standard deviation {q.with_unit(s.std)}, 95 % from "
        f"{q.range_text(s.low, s.high)} {q.unit}. {source_words(s)}"
    )
    if s.dropped:
        sentence += f" {s.dropped} designs could not be built or solved and are left out."
    bought = ("× 0.75", "× 0.5", "× 0.25", "perfect") if s.tightened else ()
    heads = ("Sobol, first", "Sobol, total") if s.indices else ()
    yield Heading("Scatter, and how much a tighter tolerance narrows it")
    yield Paragraph(sentence)
    yield Table(
        (
            Column("Input", grow=1),
            Column("Value"),
            *(Column(h, "right") for h in (*heads, *bought)),
        ),
        tuple(_inputs(s)),
    )
    if s.tightened:
        least = least_gain(s)
        hidden = f" Gains below {least:.1f} {q.unit} are sampling error." if least else ""
        yield Paragraph(
            f"The last four columns say by how many {q.unit} the 95 % range gets narrower when that "
            f"input alone scatters less.{hidden}"
        )


def source_words(s: Scatter) -> str:
    """Where indices come from and how well they are known, or why there are none."""
    if s.shares is None:
        return "No input changes this figure, so there are no shares."
    explained = s.shares.explained
    if s.surface and explained is not None:
        missed = 100 * (1 - explained)
        share = f"{missed:.2g} %" if missed >= 0.01 else "less than 0.01 %"
        return (
            "Distribution, indices and tightening come from one quadratic surface through all designs; at "
            f"designs left out of the fit the surface misses {share} of the variance (root mean square "
            f"{s.surface.misfit**0.5:.2g} {entry(s.key).unit}), which the intervals include."
        )
    tried = ""
    if explained is not None:
        tried = f" (a quadratic surface would miss {100 * (1 - explained):.2g} % of the variance)"
    if s.indices:
        return (
            f"Sobol indices come from the sample itself{tried}, which does not say how much a tighter "
            "tolerance narrows the range."
        )
    enough = s.shares.enough
    would = f"; about {enough} would be enough" if enough and enough <= MOST_EVALUATIONS else ""
    return f"Too few evaluations for Sobol indices{tried}{would}."


def index_text(value: float, ends: np.ndarray) -> str:
    """An index and its 95 % interval."""
    return f"{value:z.2f} ({ends[0]:z.2f} to {ends[1]:z.2f})"


def _inputs(s: Scatter) -> Iterable[tuple[str, ...]]:
    """A line for each input, the most important first."""
    gains, least = gains_shown(s), least_gain(s)
    for i in s.order:
        x = s.inputs[i]
        unit = entry(x.key)
        spread = x.std if x.normal else x.high - x.nominal
        kind = "s =" if x.normal else "±"
        known = s.indices
        yield (
            unit.name, f"{unit.text(x.nominal)}, {kind} {unit.with_unit(spread)}",
            *((index_text(known.first[i], known.first_ends[i]),
               index_text(known.total[i], known.total_ends[i])) if known else ()),
            *(gain_text(gains[x.key, f], least) for f in (TIGHTENING_FACTORS if s.tightened else ())),
        )  # fmt: skip
