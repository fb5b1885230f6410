"""The whole part from its sector: count, volume, orientation, seams, displacement."""

from dataclasses import replace

import numpy as np
import pytest
from hand_made_tube import (
    INNER,
    LENGTH,
    OUTER,
    corner_volumes,
    oval,
    tube,
    twisted,
)  # fmt: skip

from flexspline.fea.solid.whole import whole_part
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START
from flexspline.results.renders.surface import opening, skin

SECTORS = [(30.0, 2), (90.0, 6), (180.0, 12), (360.0, 24)]
ROUNDING = 1e-12  # of sums of a few thousand terms of order one


def assembled(sector_deg, around, shape=twisted, parity="antisymmetric"):
    mesh = tube(sector_deg, around)
    return mesh, whole_part(mesh, shape(mesh.nodes), mesh.nodes[:, 2], parity)


@pytest.mark.parametrize(("sector_deg", "around"), SECTORS)
def test_volume_and_count_are_those_of_the_sector_times_the_copies(sector_deg, around):
    mesh, whole = assembled(sector_deg, around)
    copies = round(360 / sector_deg)
    volumes = corner_volumes(whole.nodes, whole.cells)
    assert len(whole.cells) == copies * len(mesh.cells)
    assert volumes.min() > 0  # a mirrored element left inside out would be negative
    own = corner_volumes(mesh.nodes, mesh.cells).sum()
    assert volumes.sum() == pytest.approx(copies * own, rel=ROUNDING)


@pytest.mark.parametrize(("sector_deg", "around"), SECTORS)
def test_copies_share_their_nodes(sector_deg, around):
    _, whole = assembled(sector_deg, around)
    closed = tube(360.0, 24)
    assert len(whole.nodes) == len(closed.nodes)
    rounded = np.unique(np.round(whole.nodes, 6), axis=0)
    assert len(rounded) == len(whole.nodes)  # no node is there twice
    boundary = skin(whole)
    names = {whole.patches[i] for i in boundary.patch if i >= 0}
    assert names == {"", "mount", "mesh", "seat"}  # no plane of symmetry is left on the outside
    assert (boundary.patch >= 0).all()


@pytest.mark.parametrize(("sector_deg", "around"), SECTORS)
def test_torsion_is_continued_as_torsion(sector_deg, around):
    _, whole = assembled(sector_deg, around)
    np.testing.assert_allclose(whole.displacement, twisted(whole.nodes), atol=1e-15)
    np.testing.assert_allclose(whole.mises, whole.nodes[:, 2], atol=1e-12)


@pytest.mark.parametrize(("sector_deg", "around"), [(90.0, 6), (180.0, 12)])
def test_ellipse_is_continued_as_ellipse(sector_deg, around):
    _, whole = assembled(sector_deg, around, oval, "symmetric")
    np.testing.assert_allclose(whole.displacement, oval(whole.nodes), atol=1e-14)


def test_halves_whose_planes_go_by_one_name_are_joined_all_the_same():
    """At 180° both planes are one, and meshers' facets in it all go by the first name."""
    half = tube(180.0, 12)
    start, end = half.patches.index(SYMMETRY_START), half.patches.index(SYMMETRY_END)
    one = np.where(half.facet_patch == end, start, half.facet_patch)
    whole = whole_part(
        replace(half, facet_patch=one), twisted(half.nodes), half.nodes[:, 2], "antisymmetric"
    )
    assert len(np.unique(np.round(whole.nodes, 6), axis=0)) == len(whole.nodes)
    names = {whole.patches[i] for i in skin(whole).patch}
    assert names == {"", "mount", "mesh", "seat"}


def test_sector_that_does_not_fit_is_refused():
    mesh = tube(50.0, 3)
    with pytest.raises(ValueError, match="50"):
        whole_part(mesh, twisted(mesh.nodes), mesh.nodes[:, 2], "symmetric")


@pytest.mark.parametrize(("sector_deg", "around"), SECTORS[:3])
def test_section_of_the_opened_part_has_the_section_s_area(sector_deg, around):
    _, whole = assembled(sector_deg, around)
    shown = skin(whole, opening(sector_deg))
    on_plane = [i for i, name in enumerate(whole.patches) if name.startswith("symmetry")]
    section = shown.facets[np.isin(shown.patch, [-1, *on_plane])]
    a, b, c = (whole.nodes[section[:, i]] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    assert area == pytest.approx(2 * (OUTER - INNER) * LENGTH, rel=1e-9)  # two plane rectangles


def test_patches_keep_their_share_of_the_surface():
    _, whole = assembled(30.0, 2)
    shown = skin(whole)
    facets = shown.facets[shown.patch == whole.patches.index("mount")]
    a, b, c = (whole.nodes[facets[:, i]] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    polygon = 12 * np.sin(np.pi / 12)  # 24 chords instead of a circle: 24/2·sin(2π/24)·R²
    assert area == pytest.approx(polygon * (OUTER**2 - INNER**2), rel=1e-9)
