"""K_b of a body of revolution under the lobe load, on the last of the meshes that it takes."""

from __future__ import annotations

from flexspline.fea.axisymmetric.lobes import lobe_stiffnesses
from flexspline.fea.deadline import NO_DEADLINE, Deadline
from flexspline.fea.types import Elastic, Stiffness
from flexspline.geometry.outline import Meridian


def lobe_stiffness(
    outline: Meridian,
    material: Elastic,
    supported: bool,
    relative_width: float,
    deadline: Deadline = NO_DEADLINE,
) -> Stiffness:
    """As `lobe_stiffnesses`."""
    *_, last = lobe_stiffnesses(outline, material, supported, relative_width, deadline)
    return last
