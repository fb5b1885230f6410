"""The report's section on what scatters."""

from __future__ import annotations

from collections.abc import Iterable

from pipeline.study.scatter import Scatter
from results.report.document import Block, Column, Heading, Paragraph, Table
from results.study.labels import entry


def scatter_section(s: Scatter) -> Iterable[Block]:
    """Of one figure: its range, and a table over the inputs."""
    q = entry(s.key)
    sentence = (
        f"{q.name}: mean {q.with_unit(s.mean)}, standard deviation {q.with_unit(s.std)}, 95 % from "
        f"{q.range_text(s.low, s.high)} {q.unit}. The quadratic surface behind the last four columns "
        f"misses {s.surface_rms:.2g} {q.unit} (root mean square)."
    )
    if s.dropped:
        sentence += f" {s.dropped} sample blocks with a design that cannot be built are left out."
    heads = ("Sobol, first", "Sobol, total", "× 0.75", "× 0.5", "× 0.25", "perfect")
    yield Heading("What scatters, and what a tighter tolerance buys")
    yield Paragraph(sentence)
    yield Table(
        (Column("Input", grow=1), Column("Value"), *(Column(h, "right") for h in heads)),
        tuple(_inputs(s)),
    )
    yield Paragraph(
        f"The last four columns say by how many {q.unit} the 95 % range gets narrower when that input "
        "alone scatters less."
    )


def _inputs(s: Scatter) -> Iterable[tuple[str, ...]]:
    """A line for each input, the most important first."""
    for i in sorted(range(len(s.inputs)), key=lambda i: -s.indices.total[i]):
        x = s.inputs[i]
        bought = {t.factor: t.bought for t in s.tightened if t.key == x.key}
        unit = entry(x.key)
        spread = x.std if x.normal else x.high - x.nominal
        kind = "s =" if x.normal else "±"
        yield (
            unit.name, f"{unit.text(x.nominal)}, {kind} {unit.with_unit(spread)}",
            f"{s.indices.first[i]:z.2f} ± {s.indices.first_conf[i]:.2f}",
            f"{s.indices.total[i]:z.2f} ± {s.indices.total_conf[i]:.2f}",
            *(f"{max(0.0, bought[f]):.1f}" for f in (0.75, 0.5, 0.25, 0.0)),
        )  # fmt: skip
