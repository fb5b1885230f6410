"""Off-screen pictures of surfaces, in parallel projection: part points map to pixels exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flexspline.results.renders.opengl import choose_opengl

if TYPE_CHECKING:
    import pyvista as pv

OVERSAMPLING = 2
"""Rendered larger and averaged down: smooth lines on every driver. Samples within its pixels (VTK's and
pyvista's own anti-aliasing) would double the time where the processor draws, and show in no print."""

MARGIN_SHARE = 0.03
"""Of a picture's width and height, left free at each side."""


@dataclass(frozen=True)
class View:
    """Where the eye is, seen from the part, z up in the picture."""

    azimuth_deg: float
    elevation_deg: float

    @property
    def axes(self) -> np.ndarray:
        """Rows: picture right, picture up, towards the eye; unit vectors."""
        a, e = np.radians([self.azimuth_deg, self.elevation_deg])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        eye = np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])
        return np.array([right, np.cross(eye, right), eye])


@dataclass(frozen=True)
class Actor:
    """One thing to draw, pyvista's options for it, and how far to pull it towards the eye [mm].

    Lines on a surface are pulled by a little, or the surface would swallow pieces of them; in
    parallel projection that does not move them in the picture.
    """

    mesh: pv.PolyData
    options: dict[str, Any] = field(default_factory=dict)
    pull: float = 0.0


@dataclass(frozen=True)
class Shot:
    """An image (h, w, 3) and the way from part coordinates [mm] to its pixels."""

    image: np.ndarray
    view: View
    centre: np.ndarray
    mm_per_pixel: float

    def pixel(self, point: np.ndarray) -> tuple[float, float]:
        """Column and row, from the top left, of a point (3,) in mm."""
        height, width = self.image.shape[:2]
        right, up = (self.view.axes[:2] @ (np.asarray(point) - self.centre)) / self.mm_per_pixel
        return width / 2 + float(right), height / 2 - float(up)


def shoot(layers: Sequence[Actor], view: View, size: tuple[int, int]) -> Shot:
    """Draw the layers so that they fill `size` (width, height) pixels up to a margin.

    Raises
    ------
    OpenGLError : there is nothing to draw with.
    """
    from PIL import Image

    pv = _pyvista()
    axes = view.axes
    seen = np.concatenate([np.asarray(layer.mesh.points) @ axes.T for layer in layers])
    low, high = seen.min(axis=0), seen.max(axis=0)
    centre = axes.T @ ((low + high) / 2)
    width, height = size
    mm_per_pixel = float(max((high - low)[:2] / np.array(size))) / (1 - 2 * MARGIN_SHARE)
    plotter = pv.Plotter(
        off_screen=True,
        window_size=(width * OVERSAMPLING, height * OVERSAMPLING),
        lighting="none",
        theme=pv.themes.DocumentTheme(),
    )
    plotter.disable_anti_aliasing()
    try:
        plotter.set_background("white")
        _light(plotter, axes)
        for layer in layers:
            mesh = layer.mesh.translate(layer.pull * axes[2]) if layer.pull else layer.mesh
            plotter.add_mesh(mesh, show_scalar_bar=False, **layer.options)
        camera = plotter.camera
        camera.parallel_projection = True
        camera.parallel_scale = mm_per_pixel * height / 2
        camera.focal_point = tuple(centre)
        camera.position = tuple(centre + 4 * np.linalg.norm(high - low) * axes[2])
        camera.up = tuple(axes[1])
        plotter.renderer.reset_camera_clipping_range()
        big = plotter.screenshot(None, return_img=True)
    finally:
        plotter.close()
    small = np.asarray(Image.fromarray(big).reduce(OVERSAMPLING))
    return Shot(small, view, centre, mm_per_pixel)


def _light(plotter: Any, axes: np.ndarray) -> None:
    """A key light over the left shoulder and a weak one from the right, both without shine."""
    pv = _pyvista()
    right, up, eye = axes
    for direction, strength in ((eye - 0.6 * right + 0.7 * up, 0.85), (eye + 1.2 * right, 0.4)):
        plotter.add_light(
            pv.Light(
                position=tuple(1e3 * direction),
                focal_point=(0, 0, 0),
                light_type="scene light",
                intensity=strength,
            )
        )


def load(path: Path) -> None:
    """Load what draws, which takes a second, and write an empty file.

    Raises
    ------
    OpenGLError : there is nothing to draw with.
    """
    from matplotlib.backends import backend_agg

    _ = _pyvista().Plotter, backend_agg
    path.touch()


def _pyvista() -> Any:
    choose_opengl()
    import pyvista as pv

    return pv
