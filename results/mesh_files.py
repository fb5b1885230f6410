"""Meshes of whole parts for other programs, through meshio, with named patches.

Quadratic tetrahedra, and six-node triangles on every named patch, lengths in mm. meshio's `tetra10` is VTK's
quadratic tetrahedron, the order that `TetMesh` has; meshio puts gmsh's order right itself, MED's not (below).
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexspline.fea.solid.unfold import MIRRORED_CELL
from flexspline.fea.solid.whole import FACES, unloaded_part
from flexspline.fea.types import TetMesh
from flexspline.geometry.errors import DesignError
from flexspline.geometry.surfaces import SYMMETRY_END, SYMMETRY_START
from flexspline.results.file_names import FORMATS

if TYPE_CHECKING:
    import meshio

ALWAYS = ("step", "stp", "stl")
"""What `export` writes, asked or not: by the names that users give it."""
NEED_H5PY = ("med", "xdmf")
"""XDMF is written as XML alone, but meshio imports h5py for it all the same."""
NASTRAN_DIGITS = 11
"""Of the largest coordinate: what meshio's 16 characters hold beside a sign and an exponent."""

ABAQUS_FLOAT = ".12e"
"""CalculiX reads 20 characters of a number."""


@dataclass(frozen=True)
class PatchedMesh:
    """A whole part with its named patches.

    Attributes
    ----------
    part : its name, "flexspline" or "shaft".
    points : (n, 3) mm.
    tetrahedra : (m, 10) in VTK's order.
    triangles : (k, 6) of all named patches, outward: corners, then the middles of edges 01, 12, 20.
    patch : (k,) index into `patches` of each triangle.
    """

    part: str
    points: np.ndarray
    tetrahedra: np.ndarray
    triangles: np.ndarray
    patch: np.ndarray
    patches: tuple[str, ...]

    @classmethod
    def of(cls, part: str, mesh: TetMesh) -> PatchedMesh:
        """The part in the round from its sector; planes of symmetry are inside it and no patches."""
        whole = unloaded_part(mesh)
        inside = ("", SYMMETRY_START, SYMMETRY_END)
        outer = [i for i, name in enumerate(whole.patches) if name not in inside]
        cell, face = np.nonzero(np.isin(whole.face_patch, outer))
        return cls(
            part,
            whole.nodes,
            whole.cells,
            whole.cells[cell[:, None], FACES[face]],
            np.searchsorted(outer, whole.face_patch[cell, face]),
            tuple(whole.patches[i] for i in outer),
        )

    @property
    def groups(self) -> tuple[tuple[int, str], ...]:
        """Numbers, from 1, and names of the body and the patches."""
        return tuple(enumerate((self.part, *self.patches), 1))

    def nodes_on(self, patch: int) -> np.ndarray:
        """Sorted indices of the nodes of a patch, its edges included."""
        return np.unique(self.triangles[self.patch == patch])

    def numbered(self, *names: str, sign: int = 1) -> meshio.Mesh:
        """With cell data `names`: 1 in the body, 2 and on, as in `groups`, on the patches, times `sign`."""
        import meshio

        blocks = [("tetra10", self.tetrahedra), ("triangle6", self.triangles)]
        data = [np.full(len(self.tetrahedra), sign), sign * (2 + self.patch)]
        return meshio.Mesh(self.points, blocks, cell_data={name: data for name in names})


def chosen_formats(words: Sequence[str]) -> tuple[str, ...]:
    """Formats of `--format`, each once; a word may hold several with commas between.

    Raises
    ------
    DesignError : an unknown one, or one whose library is not installed.
    """
    formats = tuple(dict.fromkeys(f.strip() for word in words for f in word.split(",")))
    for name in formats:
        if name in ALWAYS:
            others = f"--format adds mesh files: one of {', '.join(FORMATS)}"
            raise DesignError("--format", name, f"STEP and STL are always written; {others}")
        if name not in FORMATS:
            raise DesignError("--format", name, f"must be one of {', '.join(FORMATS)}")
    lacking = [name for name in formats if name in NEED_H5PY]
    if lacking and find_spec("h5py") is None:
        need = "needs" if len(lacking) == 1 else "need"
        reason = f'{need} h5py, which is not installed: pip install "flexspline[hdf5]"'
        raise DesignError("--format", ",".join(lacking), reason)
    return formats


def write_mesh(mesh: PatchedMesh, path: Path) -> None:
    """In the format that the file's suffix names."""
    WRITERS[path.suffix.removeprefix(".")](mesh, path)


def _gmsh(mesh: PatchedMesh, path: Path) -> None:
    """MSH 2.2, binary: the body and the patches are physical groups."""
    made = mesh.numbered("gmsh:physical", "gmsh:geometrical")
    made.field_data = {name: np.array([i, 3 if i == 1 else 2]) for i, name in mesh.groups}
    made.write(path, file_format="gmsh22")


def _med(mesh: PatchedMesh, path: Path) -> None:
    """MED 3.0: the body and the patches are groups of elements.

    MED turns a tetrahedron the other way (Salome, SMESH, "Nodal connectivity of elements"): corners 1 and
    2 exchanged, the middles of the edges with them.
    """
    made = mesh.numbered("cell_tags", sign=-1)  # families of elements have negative numbers
    made.cells[0].data = mesh.tetrahedra[:, MIRRORED_CELL]
    made.cell_tags = {-i: [name] for i, name in mesh.groups}
    whole = io.BytesIO()  # HDF5 crashes where it meets a full disk itself
    made.write(whole, file_format="med")
    path.write_bytes(whole.getvalue())


def _nastran(mesh: PatchedMesh, path: Path) -> None:
    """Bulk data: the number of the property is the body's or the patch's; comments give the names."""
    made = mesh.numbered("nastran:ref")
    before_point = int(np.floor(np.log10(np.abs(mesh.points).max()))) + 1
    made.points = np.round(mesh.points, NASTRAN_DIGITS - before_point)
    text = io.StringIO()
    made.write(text, file_format="nastran")
    lines = [f"$ mm; property {i}: {name}\n" for i, name in mesh.groups]
    path.write_text("".join(lines) + text.getvalue(), encoding="ascii")


def _abaqus(mesh: PatchedMesh, path: Path) -> None:
    """The body is a set of C3D10 elements, each patch a set of nodes."""
    import meshio

    made = meshio.Mesh(
        mesh.points,
        [("tetra10", mesh.tetrahedra)],
        cell_sets={mesh.part.upper(): [np.arange(len(mesh.tetrahedra))]},
        point_sets={name.upper(): mesh.nodes_on(i) for i, name in enumerate(mesh.patches)},
    )
    text = io.StringIO()
    made.write(text, file_format="abaqus", float_fmt=ABAQUS_FLOAT)
    # of the many kinds of ten nodes meshio takes the last that it knows, which CalculiX does not
    path.write_text(text.getvalue().replace("TYPE=C3D10MH", "TYPE=C3D10"), encoding="ascii")


def _vtu(mesh: PatchedMesh, path: Path) -> None:
    """Each patch is cell data of its name: 1 on its triangles, else 0."""
    made = mesh.numbered()
    outside = np.zeros(len(mesh.tetrahedra), np.int32)
    for i, name in enumerate(mesh.patches):
        made.cell_data[name] = [outside, (mesh.patch == i).astype(np.int32)]
    made.write(path, file_format="vtu")


def _xdmf(mesh: PatchedMesh, path: Path) -> None:
    """Each patch is point data of its name: 1 at its nodes, else 0; all in one file, as XML.

    meshio cannot read six-node triangles and ten-node tetrahedra from one XDMF file.
    """
    import meshio

    made = meshio.Mesh(mesh.points, [("tetra10", mesh.tetrahedra)])
    for i, name in enumerate(mesh.patches):
        made.point_data[name] = np.zeros(len(mesh.points), np.int32)
        made.point_data[name][mesh.nodes_on(i)] = 1
    made.write(path, file_format="xdmf", data_format="XML")


WRITERS: dict[str, Callable[[PatchedMesh, Path], None]] = {
    "msh": _gmsh,
    "med": _med,
    "bdf": _nastran,
    "inp": _abaqus,
    "vtu": _vtu,
    "xdmf": _xdmf,
}
"""By suffix (`FORMATS`): gmsh, Salome and Code_Aster, Nastran, Abaqus and CalculiX, ParaView, FEniCS."""
