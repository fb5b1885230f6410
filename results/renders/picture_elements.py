"""Common elements of part pictures: view, section faces, peak, colour range, magnification."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from flexspline.fea.types import StressPeak
from flexspline.results.numbers import round_number
from flexspline.results.quantities import quantity
from flexspline.results.renders.scene import Actor, View
from flexspline.results.renders.sheet import Bar, Mark
from flexspline.results.renders.surface import Opening, Skin, creases, surface
from flexspline.results.style import COLOUR_MAP, INK

if TYPE_CHECKING:
    import pyvista as pv

MATT = {"ambient": 0.5, "diffuse": 0.62, "specular": 0.0}
"""Shares of VTK's light, no gloss: where colours mean no stress, shading shows the shape."""
FLAT_LIT = {"ambient": 0.7, "diffuse": 0.36, "specular": 0.0}
"""Little shading, so that the colour stays the one in the scale."""


def cut_view(cut: Opening) -> View:
    """Into the opening, a little off its middle, from above the free end."""
    off = 8.0 if cut.width_deg < 180 else 28.0
    return View(cut.middle_deg + off, 28.0)


def below_view(cut: Opening) -> View:
    """The held end, from below on the side that is not cut open."""
    return View(cut.middle_deg + 180.0, -42.0)


def wires(mesh: pv.PolyData, colour: str, width: float) -> Actor:
    """Lines of `width` pixels at the rendering's size, kept above the surface they lie on."""
    pull = 1.5e-3 * mesh.length
    return Actor(mesh, {"color": colour, "line_width": width, "lighting": False}, pull)


def stress_layers(
    points: np.ndarray, mises: np.ndarray, shown: Skin, peak: StressPeak, line: float = 2.4
) -> list[Actor]:
    """The skin coloured by von Mises stress from 0 to the reported peak, with its creases."""
    skin_mesh = surface(points, shown.facets).copy(deep=False)
    skin_mesh.point_data["mises"] = mises[skin_mesh.point_data["node"]]
    options = {
        "scalars": "mises",
        "cmap": COLOUR_MAP,
        "clim": (0.0, peak.mises_MPa),
        "n_colors": 256,
        **FLAT_LIT,
    }
    return [Actor(skin_mesh, options), wires(creases(points, shown.facets), INK, line)]


def stress_bar(peak: StressPeak, beyond: bool) -> Bar:
    """The colour scale; it ends at the reported peak: sharp corners have no finite stress."""
    stress = quantity("torque_peak_mises_MPa")
    top = stress.text(peak.mises_MPa)
    return Bar(f"von Mises\nin {stress.unit}", peak.mises_MPa, top, beyond)


def stress_note(peak: StressPeak, beyond: bool) -> str:
    """One line about the colour range."""
    if peak.at_excluded_border:
        return f"Colours end at the stress {peak.exclusion_mm:.3g} mm from sharp edges; nearer, it is higher."
    if beyond:
        return "Colours end at the peak; at sharp corners the stress has no limit."
    return "Colours end at the peak."


def goes_beyond(peak: StressPeak, shown: Skin, mises: np.ndarray) -> bool:
    """Whether some drawn point has a stress above the reported peak."""
    return bool(mises[shown.facets].max() > 1.001 * peak.mises_MPa)


@dataclass(frozen=True)
class Seen:
    """One view of a skin: deformed or not, `points` (n, 3) mm are where the nodes are drawn."""

    points: np.ndarray
    shown: Skin
    view: View


def peak_mark(
    peak: StressPeak, sector_deg: float, nodes: np.ndarray, main: Seen, inset: Seen
) -> Mark:
    """The reported peak, at the copy of its place that faces an eye, the main view's first.

    Parameters
    ----------
    sector_deg : of the mesh that was solved; the place repeats with it.
    nodes : (n, 3) undeformed nodes of the whole part, mm.
    """
    places = _copies(np.array(peak.at_mm), sector_deg)
    copies = [int(np.argmin(((nodes - place) ** 2).sum(axis=1))) for place in places]
    name = "peak, at border\nof excluded zone" if peak.at_excluded_border else "peak"
    text = f"{name}\n" + quantity("torque_peak_mises_MPa").with_unit(peak.mises_MPa)
    for seen in (main, inset):
        drawn = surface(seen.points, seen.shown.facets)
        eye = seen.view.axes[2]
        on_skin = np.isin(copies, seen.shown.facets)
        facing = sorted(np.array(copies)[on_skin], key=lambda n: -float(seen.points[n] @ eye))
        for node in facing:
            if _is_visible(drawn, seen.points[node], eye):
                return Mark(seen.points[node], text, "main" if seen is main else "inset")
    nearest = max(copies, key=lambda n: float(main.points[n] @ main.view.axes[2]))
    return Mark(main.points[nearest], f"{text}\n(hidden)", "none")


def magnification(largest_mm: float, size_mm: float) -> float:
    """A round number that brings the largest displacement near 1/10 of the part."""
    return round_number(size_mm / 10 / largest_mm)


def sector_words(sector_deg: float) -> str:
    """How much of the part the mesh covers."""
    if sector_deg >= 360:
        return "the whole part"
    return f"a sector of {sector_deg:g}° (1/{360 / sector_deg:g} of the part)"


def _copies(at: np.ndarray, sector_deg: float) -> list[np.ndarray]:
    if sector_deg >= 360:
        return [at]
    copies = []
    for turn in np.radians(np.arange(0.0, 360.0, 2 * sector_deg)):
        for y in (at[1], -at[1]):
            c, s = np.cos(turn), np.sin(turn)
            copies.append(np.array([c * at[0] - s * y, s * at[0] + c * y, at[2]]))
    return copies


def _is_visible(drawn: pv.PolyData, point: np.ndarray, eye: np.ndarray) -> bool:
    """Whether nothing of the surface lies between the point and the eye."""
    size = drawn.length
    hits, _ = drawn.ray_trace(point + 2 * size * eye, point - 1e-3 * size * eye)
    return len(hits) == 0 or bool(((hits - point) @ eye).max() < 1e-3 * size)
