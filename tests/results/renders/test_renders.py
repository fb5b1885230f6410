"""Pictures of parts: size, ink, and that a place of the part is where the picture shows it."""

import numpy as np
import pytest
from hand_made_tube import INNER, LENGTH, OUTER, field, oval, tube, twisted
from PIL import Image

from flexspline.fea.solid.whole import whole_part
from flexspline.results.renders.ellipse_picture import write_ellipse_picture
from flexspline.results.renders.mesh_picture import write_mesh_picture
from flexspline.results.renders.picture_elements import Seen, magnification, peak_mark
from flexspline.results.renders.scene import Actor, View, shoot
from flexspline.results.renders.stress_picture import write_torque_stress
from flexspline.results.renders.surface import opening, skin


def pixels(path):
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def check_picture(path):
    image = pixels(path)
    assert image.shape == (1200, 1600, 3)
    inked = (image < 250).any(axis=2).mean()
    assert 0.1 < inked < 0.8  # a part, and white paper around it
    assert (image[0] == 255).all()
    assert (image[-1] == 255).all()  # nothing runs over the edge
    assert (image[:, 0] == 255).all()
    assert (image[:, -1] == 255).all()
    return image


@pytest.mark.opengl
def test_mesh_picture(tmp_path):
    write_mesh_picture(tmp_path / "mesh.png", tube(30.0, 2), "Flexspline")
    check_picture(tmp_path / "mesh.png")


@pytest.mark.opengl
def test_stress_picture_of_a_half_part(tmp_path):
    mesh = tube(180.0, 12)
    made = field(mesh, twisted(mesh.nodes), (0.0, OUTER, LENGTH))
    write_torque_stress(tmp_path / "stress.png", made, "Output shaft", 0.5)
    image = check_picture(tmp_path / "stress.png")
    # the scale stands right of the views: dark violet below, yellow on top
    column = image[200:1060, 1430].astype(int)
    blue_ish = column[:, 2] - column[:, 0]
    assert blue_ish[-150:].max() > 20
    assert blue_ish[:300].min() < -100


@pytest.mark.opengl
def test_ellipse_picture(tmp_path):
    mesh = tube(90.0, 6)
    made = field(mesh, oval(mesh.nodes), (OUTER, 0.0, LENGTH))
    write_ellipse_picture(tmp_path / "ellipse.png", made, 0.2)
    check_picture(tmp_path / "ellipse.png")


@pytest.mark.opengl
def test_same_content_gives_the_same_bytes(tmp_path):
    mesh = tube(30.0, 2)
    for name in ("a.png", "b.png"):
        write_mesh_picture(tmp_path / name, mesh, "Flexspline")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


@pytest.mark.opengl
def test_a_point_s_pixel_is_where_the_renderer_draws_it():
    import pyvista as pv

    at = np.array([3.0, -2.0, 4.0])
    box = pv.Box((-6, 6, -6, 6, -1, 7))
    layers = [
        Actor(box, {"color": "white", "lighting": False}),
        Actor(pv.Sphere(radius=0.3, center=at), {"color": "red", "lighting": False}, pull=30.0),
    ]
    shot = shoot(layers, View(35.0, 25.0), (400, 300))
    red = (shot.image[..., 0] > 200) & (shot.image[..., 1] < 60)
    rows, columns = np.nonzero(red)
    # pixel centres lie half a pixel inside; the sphere is a few pixels wide: centroid within one
    assert shot.pixel(at) == pytest.approx((columns.mean() + 0.5, rows.mean() + 0.5), abs=1.0)


def test_peak_is_marked_at_a_copy_that_faces_the_eye():
    mesh = tube(30.0, 2)
    angle = np.radians(15.0)
    at = (OUTER * np.cos(angle), OUTER * np.sin(angle), 6.0)
    made = field(mesh, twisted(mesh.nodes), at)
    whole = whole_part(mesh, made.displacement, made.mises, "antisymmetric")
    cut = opening(mesh.sector_deg)
    eye = View(cut.middle_deg + 20, 28.0)
    seen = Seen(whole.nodes, skin(whole, cut), eye)
    mark = peak_mark(made.peak, mesh.sector_deg, whole.nodes, seen, seen)
    assert np.hypot(*mark.at_mm[:2]) == pytest.approx(OUTER, abs=1e-9)
    assert mark.at_mm[2] == pytest.approx(6.0, abs=1e-9)
    assert mark.shown_by == "main"
    assert "1.90" in mark.text
    # a point of the outer surface is seen only from its own side
    assert mark.at_mm[:2] @ eye.axes[2][:2] > 0


def test_peak_that_no_view_shows_says_so():
    mesh = tube(30.0, 2)
    made = field(mesh, twisted(mesh.nodes), (INNER, 0.0, 0.0))
    whole = whole_part(mesh, made.displacement, made.mises, "antisymmetric")
    above = Seen(whole.nodes, skin(whole), View(0.0, 5.0))  # the tube's inner floor edge: hidden
    mark = peak_mark(made.peak, mesh.sector_deg, whole.nodes, above, above)
    assert mark.shown_by == "none"
    assert "hidden" in mark.text


@pytest.mark.parametrize(
    ("largest", "size", "factor"), [(0.2, 40.0, 20.0), (0.3, 40.0, 10.0), (5e-5, 40.0, 5e4)]
)
def test_magnification_is_a_round_number_that_shows_about_a_tenth(largest, size, factor):
    assert magnification(largest, size) == pytest.approx(factor)
