"""K of shafts between those of two shafts without fillets.

Two ways to know that the enclosure is right: bodies of revolution, whose K has bounds by theorem; and the
tetrahedra of the shaft itself, fillets included.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shaft_of import shaft_of

from flexspline.fea.axisymmetric.torsion import torsional_stiffness
from flexspline.fea.types import Elastic, Stiffness
from flexspline.geometry.nested import unfilleted_bodies
from flexspline.geometry.part import Part
from flexspline.pipeline import torque_stress, unfilleted_shaft
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.enclosure import overlap
from flexspline.pipeline.part_stiffness import turned_field, twisted_part
from flexspline.pipeline.parts import AnalysisContext, PartModel
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.solid_torsion import TwistedPart

STEPS = [(4.0, 20.0, 6.0), (12.0, 14.0, 6.0), (6.0, 17.0, 5.0), (20.0, 12.0, 5.0)]
KEYWAY = """
grip_length_mm = 8
[keyway]
width_mm = 4.0
depth_mm = 2.5
length_mm = 12.0
"""
TOLERANCE = 0.03
"""Of K: one mesh each of the solid model."""
FINE = 1e-4
"""Of the meridian's bounds: a tenth of what a fillet of 0.02 mm does to K."""


def by_theorem(part: Part) -> Stiffness:
    found = torsional_stiffness(part.meridian, Elastic.of(part.material), part.driven, FINE)
    assert found.guaranteed
    return found


@pytest.mark.parametrize(
    "fillet", [*(pytest.param(f, marks=pytest.mark.long) for f in (0.02, 0.1, 0.5)), 1.0]
)
def test_bodies_of_revolution(fillet: float) -> None:
    part = shaft_of(STEPS, fillet=fillet).part("shaft")
    bodies = unfilleted_bodies(part)
    less, own, more = (by_theorem(body) for body in (bodies.cut, part, bodies.whole))
    assert less.lower_Nm_per_rad < own.upper_Nm_per_rad
    assert own.lower_Nm_per_rad < more.upper_Nm_per_rad
    apart = more.K_Nm_per_rad / less.K_Nm_per_rad - 1
    # three moved steps in 42 mm less the grip: each makes one fillet of length up to (20/12)^4 times as stiff
    assert 0 < apart < 3 * fillet / (42 - 5) * 8
    if fillet >= 0.1:  # beyond what the bounds leave open
        assert less.upper_Nm_per_rad < own.lower_Nm_per_rad < own.upper_Nm_per_rad
        assert own.upper_Nm_per_rad < more.lower_Nm_per_rad


@pytest.fixture(scope="module")
def shaft(tmp_path_factory: pytest.TempPathFactory) -> PartModel:
    """Keyed, its fillets large enough for a mesh."""
    design = shaft_of(STEPS, KEYWAY, fillet=0.4)
    cache = Cache(tmp_path_factory.mktemp("keyed"))
    return AnalysisContext(design, cache, Progress()).part("shaft")


@pytest.fixture(scope="module")
def between(shaft: PartModel) -> TwistedPart:
    """What is answered where its mesh with fillets has too many elements."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(unfilleted_shaft, "MOST_WITH_FILLETS", 10)
        return unfilleted_shaft.twisted_shaft(shaft, TOLERANCE)


def test_a_keyed_shaft(shaft: PartModel, between: TwistedPart) -> None:
    usual = unfilleted_shaft.twisted_shaft(shaft, TOLERANCE)
    assert not usual.without_fillets
    assert between.without_fillets
    found = between.stiffness
    assert not found.guaranteed
    assert overlap(usual.stiffness, found)
    # its own error, and three steps of 0.4 mm: 3 % of the length twists less
    assert found.half_width < TOLERANCE + 0.03
    assert bool(found.shortfall) == (found.half_width > TOLERANCE)
    assert found.lower_Nm_per_rad < usual.stiffness.K_Nm_per_rad < found.upper_Nm_per_rad


def test_its_stress_is_compared_with_no_limit(
    shaft: PartModel, between: TwistedPart, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The fillets, where it is largest, are not in the mesh; the field is that of the torque on that mesh."""
    twisted = between
    monkeypatch.setattr(torque_stress, "twisted_part", lambda _: twisted)
    field = torque_stress.torque_field(shaft)
    assert field.left_out == "its fillets"
    assert field.peak.at_excluded_border
    assert "its fillets, which the mesh leaves out" in field.peak.excluded
    assert field.peak.left_out == "its fillets"
    torque = shaft.context.design.load.torque_Nm
    mesh, mine = twisted.meshed.mesh, shaft.part.driven
    # the grip turns by T/K of its own mesh, at every radius
    grip = mesh.nodes_on(mine)
    turned = np.linalg.norm(field.displacement[grip], axis=1)
    radius = np.hypot(*mesh.nodes[grip, :2].T)
    K = turned_field(shaft, twisted).K_Nm_per_rad
    assert turned / radius == pytest.approx(torque / K, rel=1e-9)


def test_the_peak_of_a_body_of_revolution_has_its_fillets(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is the meridian's, whatever mesh the picture has."""
    model = AnalysisContext(shaft_of(STEPS, fillet=0.4), Cache(tmp_path), Progress()).part("shaft")
    twisted = replace(twisted_part(model), without_fillets=True)
    monkeypatch.setattr(torque_stress, "twisted_part", lambda _: twisted)
    field = torque_stress.torque_field(model)
    assert field.left_out == "its fillets"
    assert not field.peak.left_out
