"""A scene for the page holds the part that was solved: places, stress and lines, as the eye sees them."""

import base64
import json
import zlib

import numpy as np
import pytest
from hand_made_tube import LENGTH, OUTER, field, oval, tube, twisted
from read_arrays import read_arrays

from flexspline.results.page_3d.arrays import packed
from flexspline.results.renders.ellipse_picture import turning_ellipse
from flexspline.results.renders.stress_picture import turning_torque_stress
from flexspline.results.style import ACCENT, INK


def scene(view):
    return read_arrays(zlib.decompress(base64.b64decode(json.loads(view)["scene"])))


def places(found):
    return found["places"].T * found["step_mm"] + found["low_mm"]


def test_arrays_come_back():
    arrays = {
        "short": np.arange(3, dtype=np.uint16),
        "whole": np.array([[70000, 1], [2, 3]]),
        "real": np.array([[0.5], [-1.25]]),
    }
    found = read_arrays(packed({"name": "Größe"}, arrays))
    assert found.pop("name") == "Größe"
    assert {n: a.dtype.name for n, a in found.items()} == {
        "short": "uint16", "whole": "uint32", "real": "float32"
    }  # fmt: skip
    for name, array in arrays.items():
        assert (found[name] == array).all()


def test_a_part_under_torque_is_all_there():
    """Half of a tube, cut open: area of its surface in closed form, chords for arcs apart."""
    mesh = tube(180.0, 24)
    made = field(mesh, twisted(mesh.nodes), (0.0, OUTER, LENGTH))
    found = scene(turning_torque_stress(made, "Output shaft", 0.5))
    at, triangles = places(found), found["triangles"]
    drawn = at[np.unique(triangles)]
    nodes = mesh.nodes
    far = [np.linalg.norm(nodes * [1, s, 1] - p, axis=1).min() for p in drawn for s in (1, -1)]
    assert np.reshape(far, (-1, 2)).min(axis=1).max() < found["step_mm"]  # a node, or its mirror's
    assert found["lines"] == {"edges": INK}
    radii = np.hypot(*at[found["edges"]].reshape(-1, 3)[:, :2].T)
    assert radii.max() == pytest.approx(OUTER, rel=1e-3)
    assert found["along"].max() <= found["levels"]
    assert len(found["along"]) == triangles.max() + 1


def test_the_edges_before_deformation_are_the_undeformed_ones():
    mesh = tube(90.0, 6)
    found = scene(turning_ellipse(field(mesh, oval(mesh.nodes), (OUTER, 0.0, LENGTH)), 0.2))
    assert found["lines"] == {"edges": INK, "before": ACCENT}
    at = places(found)
    radii = np.hypot(*at[found["before"]].reshape(-1, 3)[:, :2].T)
    assert np.ptp(radii[radii > radii.mean()]) < 0.01 * OUTER  # round
    moved = np.hypot(*at[np.unique(found["triangles"])][:, :2].T)
    assert moved.max() > 1.05 * OUTER  # the ellipse is not
