"""FE of one specimen: the compliance of its parts, with holes or as a ratio of the hole-free model.

The row's own stiffness comes from the design's model, holes included, or, where stiffnesses are given
instead of FE, from them, scaled by the ratio of the hole-free axisymmetric model.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace

from flexspline.fea.shortfall import settled
from flexspline.fea.types import Elastic
from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.keys import with_values, without_holes
from flexspline.geometry.part import NO_HOLES
from flexspline.geometry.part_name import PartName
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import Specimens
from flexspline.pipeline.part_stiffness import part_stiffness
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.revolved import lobes, torsion

BENCH_TORSION_WIDTH = 1e-3
"""Width of the bounds of the hole-free model's K over K. A step of `sensitivity.SMALLEST_STEP` changes K by
more than ten times as much."""
BENCH_LOBE_WIDTH = 5e-3
"""The same at the lobes, whose harmonics cost more: of the example cup (K_b 31 377 uniform, 26 832 at the
lobes) it is 3 % of the way between them, a quarter of the narrower prior in `parameters.ZONES`."""


@dataclass(frozen=True)
class Bench:
    """Computes compliances. `K_b`, `K_e` [N·m/rad] belong to the nominal design.

    `full`: rows are solved with their holes; else K_b and K_e are scaled by the hole-free model.
    """

    context: AnalysisContext
    K_b: float
    K_e: float
    full: bool

    def compliance(self, design: Design, part: PartName) -> float:
        """Of one part of a design [rad per N·m], load case as in the sum."""
        nominal = self.K_b if part == "flexspline" else self.K_e
        mine, other = self._model(design, part), self._model(self.context.design, part)
        return mine / other / nominal

    def _model(self, design: Design, part: PartName) -> float:
        lobed = enters_at_lobes(design, part)
        if self.full and not lobed:
            return 1 / part_stiffness(replace(self.context, design=design).part(part)).K_Nm_per_rad
        return self.plain(design, part, lobed)

    def as_in_sum(self, design: Design, part: PartName) -> float:
        """`plain` for the load case of the sum, fine enough for slopes."""
        return self.plain(design, part, enters_at_lobes(design, part), BENCH_TORSION_WIDTH)

    def plain(
        self,
        design: Design,
        part: PartName,
        lobed: bool = False,
        relative_width: float | None = None,
    ) -> float:
        """Compliance [rad per N·m] of the part without holes."""
        solid = replace(self.context, design=design).part(part).context.design
        own = without_holes(solid).part(part)
        material = Elastic.of(own.material)
        # without bolts, the circle and diameter of holes may still be stated
        shape = own.shape.model_copy(update=NO_HOLES).model_dump(mode="json")
        width = relative_width or (BENCH_LOBE_WIDTH if lobed else BENCH_TORSION_WIDTH)

        def make() -> float:
            stiffness = lobes(own, True, width) if lobed else torsion(own, width)
            return 1 / settled(stiffness).K_Nm_per_rad

        inputs = {"part": part, "shape": shape, "material": asdict(material), "lobed": lobed,
                  "relative_width": width}  # fmt: skip
        return float(self.context.cache.get("specimen", inputs, make)[0])


def enters_at_lobes(design: Design, part: PartName) -> bool:
    """Whether the torque enters a part at the lobes, in the load case of the sum."""
    return part == "flexspline" and design.solver.sum_at_lobes


def row_designs(design: Design, specimens: Specimens) -> tuple[Design, ...]:
    """The design of every row.

    Raises
    ------
    MeasurementError : an override that makes no design; with the row's line.
    """
    designs = []
    for i in range(len(specimens.specimen)):
        own = {key: float(values[i]) for key, values in specimens.overrides.items()}
        try:
            designs.append(with_values(design, own))
        except DesignError as fault:
            raise MeasurementError(specimens.path, int(specimens.line[i]), str(fault)) from None
    return tuple(designs)
