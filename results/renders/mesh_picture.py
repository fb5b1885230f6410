"""A part cut open, with its element edges and its named patches."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from flexspline.fea.solid.whole import WholePart, unloaded_part
from flexspline.fea.types import TetMesh
from flexspline.results.numbers import grouped
from flexspline.results.renders.picture_elements import (
    MATT,
    below_view,
    cut_view,
    sector_words,
    wires,
)
from flexspline.results.renders.scene import Actor, shoot
from flexspline.results.renders.sheet import LARGE_INSET, MAIN, Sheet, write_sheet
from flexspline.results.renders.surface import Skin, creases, element_edges, opening, skin, surface
from flexspline.results.style import INK, PALETTE, STEEL

# patch: (colour, words of the legend)
_PATCHES = {
    "mount": (PALETTE[0], "mount: held"),
    "mesh": (PALETTE[2], "mesh: takes the torque"),
    "seat": (PALETTE[1], "seat: wave generator"),
    "grip": (PALETTE[2], "grip: takes the torque"),
}
_SECTION = "#f3f5f6"


def write_mesh_picture(path: Path, mesh: TetMesh, part_name: str) -> None:
    """Write the PNG of one part; `part_name` opens the title ("Flexspline", "Output shaft")."""
    whole = unloaded_part(mesh)
    cut = opening(mesh.sector_deg)
    colour_of = {name: _PATCHES[name][0] for name in _PATCHES if name in mesh.patches}
    count = grouped(len(mesh.cells), 0)
    write_sheet(
        path,
        shoot(_layers(whole, skin(whole, cut), colour_of, 1.3), cut_view(cut), MAIN),
        shoot(_layers(whole, skin(whole), colour_of, 0.8), below_view(cut), LARGE_INSET),
        Sheet(
            title=f"{part_name}: mesh",
            subtitle=f"{count} quadratic tetrahedra in {sector_words(mesh.sector_deg)}",
            inset_title="from below",
            legend=tuple((colour, _PATCHES[name][1]) for name, colour in colour_of.items()),
        ),
    )


def _layers(whole: WholePart, shown: Skin, colour_of: dict[str, str], line: float) -> list[Actor]:
    layers = [
        Actor(surface(whole.nodes, facets), {"color": colour, **MATT})
        for colour, facets in _by_colour(whole, shown, colour_of)
        if len(facets)
    ]
    layers.append(wires(element_edges(whole.nodes, shown.facets), "#46515b", line))
    layers.append(wires(creases(whole.nodes, shown.facets), INK, 2.2 * line))
    return layers


def _by_colour(
    whole: WholePart, shown: Skin, colour_of: dict[str, str]
) -> list[tuple[str, np.ndarray]]:
    """Facets of each named patch, of the section, and of the rest."""
    index = {name: whole.patches.index(name) for name in colour_of}
    on_plane = [i for i, name in enumerate(whole.patches) if name.startswith("symmetry")]
    section = np.isin(shown.patch, [-1, *on_plane])
    named = np.isin(shown.patch, list(index.values()))
    return [
        *((colour, shown.facets[shown.patch == index[name]]) for name, colour in colour_of.items()),
        (_SECTION, shown.facets[section]),
        (STEEL, shown.facets[~section & ~named]),
    ]
