"""What makes a chart hard to read: words on words, words off the sheet, lines or legends on words.

Only what matplotlib really draws counts: ticks beyond an axis's ends and hidden things do not.
"""

from contextlib import contextmanager
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np

TOUCH_PT = 0.5
"""Points by which boxes may reach into each other: a text's box has that much air about its ink."""
SAMPLE_PX = 2.0
"""Distance of the points by which a line is followed."""
SMALLEST_PT = 6.0
"""Below it a printed figure cannot be read without a lens."""
PALE = 0.25
"""Darkness from which a bar makes black words on it hard to read."""


@contextmanager
def drawn_figures():
    """The list of figures that are saved while this is open, each as a blank sheet: `faults` draws it."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    found, draw = [], FigureCanvasAgg.draw

    def kept(canvas):
        found.append(canvas.figure)

    blank, pixels = np.zeros((1, 1, 4), np.uint8), FigureCanvasAgg.buffer_rgba
    FigureCanvasAgg.draw, FigureCanvasAgg.buffer_rgba = kept, lambda _: blank
    try:
        yield found
    finally:
        FigureCanvasAgg.draw, FigureCanvasAgg.buffer_rgba = draw, pixels


@dataclass(frozen=True)
class Box:
    """A text's frame in pixels: centre, half width and half height, angle [rad]."""

    words: str
    centre: np.ndarray
    half: np.ndarray
    angle: float
    size_pt: float
    on_ground: bool = False
    """Whether a ground of its own keeps lines from it."""

    @property
    def axes(self):
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([[c, s], [-s, c]])

    @property
    def corners(self):
        signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        return self.centre + (signs * self.half) @ self.axes

    def meets(self, other):
        """Whether two frames share any place (separating axes)."""
        for axis in (*self.axes, *other.axes):
            one, two = self.corners @ axis, other.corners @ axis
            if one.max() <= two.min() or two.max() <= one.min():
                return False
        return True

    def holds(self, points):
        """(n,) whether each of (n, 2) points lies within."""
        return (np.abs((points - self.centre) @ self.axes.T) < self.half).all(axis=1)


def faults(figure):
    """One line for each thing that is hard to read; none for a good chart."""
    boxes = _texts(figure)
    said = [f"“{a.words}” lies over “{b.words}”" for a, b in combinations(boxes, 2) if a.meets(b)]
    low, high = figure.bbox.min, figure.bbox.max
    said += [
        f"“{b.words}” leaves the sheet"
        for b in boxes
        if (b.corners < low).any() or (b.corners > high).any()
    ]
    said += [f"“{b.words}” is {b.size_pt:.1f} pt" for b in boxes if b.size_pt < SMALLEST_PT]
    for axes in figure.axes:
        for line in _lines(axes):
            bare = (b for b in boxes if not b.on_ground)
            said += [f"a line crosses “{b.words}”" for b in bare if b.holds(line).any()]
    return said + _under_legends(figure) + _on_dark_bars(figure, boxes)


def assert_legible(figures):
    """Every figure of the list is; and there is one."""
    assert figures
    for figure in figures:
        assert faults(figure) == []


def _texts(figure):
    from matplotlib.text import Text

    drawn, draw = [], Text.draw

    def noted(text, renderer):
        if text.get_visible() and text.get_text().strip():
            drawn.append(text)
        draw(text, renderer)

    Text.draw = noted
    try:
        figure.canvas.draw()
    finally:
        Text.draw = draw
    return [_box(figure, t) for t in dict.fromkeys(drawn)]


def _box(figure, text):
    from matplotlib.text import Text

    frame = text.get_bbox_patch()
    extent = frame.get_window_extent() if frame else Text.get_window_extent(text)
    angle = text.get_rotation()
    text.set_rotation(0)
    flat = Text.get_window_extent(text)  # an annotation's own would take in its arrow
    text.set_rotation(angle)
    size = extent.size if frame else flat.size
    air = TOUCH_PT * figure.dpi / 72
    centre = (extent.min + extent.max) / 2
    words = " ".join(text.get_text().split())
    ground = frame is not None and frame.get_facecolor()[3] > 0.7
    return Box(
        words,
        centre,
        np.maximum(size / 2 - air, 0.1),
        np.radians(angle),
        text.get_fontsize(),
        ground,
    )


def _lines(axes):
    """Points along every line of data that is drawn, in pixels; grids and scales are no data."""
    for line in axes.lines:
        if line.get_visible() and line.get_linestyle() not in ("None", "", " "):
            yield _along(line.get_transform().transform_path(line.get_path()), axes)
    for made in axes.collections:
        if type(made).__name__ == "LineCollection" and made.get_visible():
            for path in made.get_paths():
                yield _along(made.get_transform().transform_path(path), axes)


def _along(path, axes):
    """Points no more than SAMPLE_PX apart along a path, those within its axes."""
    found = [np.empty((0, 2))]
    for corners in path.to_polygons(closed_only=False):
        for a, b in pairwise(corners):
            if not np.isfinite([a, b]).all():  # a curve is broken there
                continue
            count = min(int(np.hypot(*(b - a)) // SAMPLE_PX) + 2, 4000)
            found.append(a + np.linspace(0, 1, count)[:, None] * (b - a))
    points = np.concatenate(found)
    inside = ((points >= axes.bbox.min - 1) & (points <= axes.bbox.max + 1)).all(axis=1)
    return points[inside]


def _marks(axes):
    """Pixels of the marks of each line of data."""
    for line in axes.lines:
        if line.get_visible() and line.get_marker() not in ("None", "", " ", None):
            yield line.get_transform().transform(line.get_xydata())


def _under_legends(figure):
    """Bars, lines and marks that a legend covers."""
    said = []
    legends = [a.get_legend() for a in figure.axes] + figure.legends
    for legend in filter(None, legends):
        low, high = legend.get_window_extent().min, legend.get_window_extent().max
        for axes in figure.axes:
            for bar in axes.patches:
                b = bar.get_window_extent()
                if (b.min < high).all() and (b.max > low).all() and (b.size > 0.5).all():
                    said.append("a legend covers a bar")
            for points in (*_lines(axes), *_marks(axes)):
                if ((points > low) & (points < high)).all(axis=1).any():
                    said.append("a legend covers a line or marks")
    return said


def _on_dark_bars(figure, boxes):
    """Words on a bar too dark for them."""
    from matplotlib.colors import to_rgba
    from matplotlib.patches import Rectangle

    said = []
    for axes in figure.axes:
        for bar in axes.patches:
            *rgb, alpha = to_rgba(bar.get_facecolor())
            dark = alpha * (1 - np.dot(rgb, (0.2126, 0.7152, 0.0722)))
            b = bar.get_window_extent()
            if not isinstance(bar, Rectangle) or not bar.get_visible() or dark < PALE:
                continue
            for box in boxes:
                low, high = box.corners.min(axis=0), box.corners.max(axis=0)
                if min(b.size) > 1 and (low < b.max).all() and (high > b.min).all():
                    said.append(f"“{box.words}” lies on a dark bar")
    return said
