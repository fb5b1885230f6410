"""Every mesh format is read back by meshio: nodes, tetrahedra, patches are those of the tube."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from dataclasses import replace
from math import pi
from pathlib import Path

import meshio
import numpy as np
import pytest
from hand_made_tube import INNER, LENGTH, OUTER, RING_START, tube
from typer.testing import CliRunner

from flexspline.fea.solid.load_cases import torsion
from flexspline.fea.solid.model import Model
from flexspline.fea.types import NMM_PER_NM, Elastic
from flexspline.geometry.errors import DesignError
from flexspline.results.cli import app
from flexspline.results.export import ENDINGS
from flexspline.results.file_names import FORMATS
from flexspline.results.mesh_files import WRITERS, PatchedMesh, chosen_formats, write_mesh

VOLUME = pi * (OUTER**2 - INNER**2) * LENGTH
AREAS = {
    "mount": pi * (OUTER**2 - INNER**2),
    "mesh": 2 * pi * OUTER * (LENGTH - RING_START),
    "seat": 2 * pi * INNER * (LENGTH - RING_START),
}
BY_PARABOLAS = 1e-4
"""Parabolas for arcs of 15°: a circle's area by them is 6e-5 short."""
MIDDLES = np.array([[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]])
EVERY = sorted(WRITERS)
MED_TURNS = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]
"""MED's tetrahedron in VTK's order: corners 1 and 2 are exchanged, and so are the middles at them."""


@pytest.fixture(scope="module")
def whole() -> PatchedMesh:
    return PatchedMesh.of("flexspline", tube(30.0, 2))


def read(whole: PatchedMesh, suffix: str, folder: Path) -> meshio.Mesh:
    path = folder / f"flexspline.{suffix}"
    write_mesh(whole, path)
    assert [p.name for p in folder.iterdir()] == [path.name]  # whole in one file
    return meshio.read(path, file_format="gmsh" if suffix == "msh" else None)


def tetrahedra(found: meshio.Mesh, suffix: str) -> np.ndarray:
    cells = found.cells_dict["tetra10"]
    return cells[:, MED_TURNS] if suffix == "med" else cells


def triangles(found: meshio.Mesh, suffix: str, folder: Path) -> dict[str, np.ndarray]:
    """Six-node triangles (k, 6) by the name of their patch."""
    cells = found.cells_dict["triangle6"]
    if suffix == "vtu":
        return {name: cells[found.cell_data_dict[name]["triangle6"] == 1] for name in AREAS}
    if suffix == "msh":
        number = {name: tag for name, (tag, dim) in found.field_data.items() if dim == 2}
        tags = found.cell_data_dict["gmsh:physical"]["triangle6"]
    elif suffix == "med":
        number = {name: tag for tag, (name,) in found.cell_tags.items()}
        tags = found.cell_data_dict["cell_tags"]["triangle6"]
    elif suffix == "bdf":
        text = (folder / "flexspline.bdf").read_text(encoding="ascii")
        number = {name: int(tag) for tag, name in re.findall(r"property (\d+): (\w+)", text)}
        tags = found.cell_data_dict["nastran:ref"]["triangle6"]
    else:
        pytest.fail(f"say in {Path(__file__).name} how {suffix} names the patches")
    return {name: cells[tags == number[name]] for name in AREAS}


def body_number(found: meshio.Mesh, suffix: str) -> tuple[int, np.ndarray]:
    """What the format says of the body by name, and of each tetrahedron."""
    if suffix == "msh":
        return found.field_data["flexspline"][0], found.cell_data_dict["gmsh:physical"]["tetra10"]
    (tag,) = [tag for tag, names in found.cell_tags.items() if names == ["flexspline"]]
    return tag, found.cell_data_dict["cell_tags"]["tetra10"]


def where(points: np.ndarray) -> dict[str, np.ndarray]:
    """Nodes of each patch by the tube's own sizes."""
    r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    ring = z > RING_START - 1e-6
    return {
        "mount": np.flatnonzero(np.isclose(z, 0, atol=1e-9)),
        "mesh": np.flatnonzero(np.isclose(r, OUTER) & ring),
        "seat": np.flatnonzero(np.isclose(r, INNER) & ring),
    }


def area(points: np.ndarray, cells: np.ndarray) -> float:
    """Of six-node triangles, a 3-point rule on each: exact to 1e-5 for such arcs."""
    total = 0.0
    for a, b in ((1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3)):
        along, across = triangle_slopes(a, b)
        x = points[cells]
        normal = np.cross(np.tensordot(x, along, (1, 0)), np.tensordot(x, across, (1, 0)))
        total += np.linalg.norm(normal, axis=1).sum() / 6
    return total


def triangle_slopes(a: float, b: float) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of the six shape functions, middles of 01, 12, 20 last."""
    c = 1 - a - b
    along = [1 - 4 * c, 4 * a - 1, 0, 4 * (c - a), 4 * b, -4 * b]
    across = [1 - 4 * c, 0, 4 * b - 1, -4 * a, 4 * a, 4 * (c - b)]
    return np.array(along), np.array(across)


@pytest.mark.parametrize("suffix", EVERY)
def test_nodes_and_tetrahedra_come_back(suffix: str, whole: PatchedMesh, tmp_path: Path) -> None:
    found = read(whole, suffix, tmp_path)
    # 11 digits of 10 mm in Nastran's fields, 13 in Abaqus'
    digits = {"bdf": 1e-9, "inp": 1e-11}.get(suffix, 1e-14)
    np.testing.assert_allclose(found.points, whole.points, atol=digits)
    assert (tetrahedra(found, suffix) == whole.tetrahedra).all()


@pytest.mark.parametrize("suffix", EVERY)
def test_each_middle_node_is_at_the_middle_of_its_edge(
    suffix: str, whole: PatchedMesh, tmp_path: Path
) -> None:
    found = read(whole, suffix, tmp_path)
    cells = tetrahedra(found, suffix)
    off = found.points[cells[:, 4:]] - found.points[cells[:, MIDDLES]].mean(axis=2)
    # arcs of 15° bend by 0.09 and slanting edges by 0.11 mm; the nearest wrong middle is 0.5 mm away
    assert np.linalg.norm(off, axis=2).max() < 0.15


@pytest.mark.parametrize("suffix", EVERY)
def test_no_element_is_inside_out(suffix: str, whole: PatchedMesh, tmp_path: Path) -> None:
    found = read(whole, suffix, tmp_path)
    written = found.cells_dict["tetra10"]
    a, b, c, d = (found.points[written[:, i]] for i in range(4))
    volumes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
    by_chords = VOLUME * np.sin(np.radians(15)) / np.radians(15)
    # Salome, SMESH, "Nodal connectivity of elements": its tetrahedron is VTK's mirrored
    sign = -1 if suffix == "med" else 1
    assert (sign * volumes).min() > 0
    assert sign * volumes.sum() == pytest.approx(by_chords, rel=1e-9)


@pytest.mark.parametrize("suffix", EVERY)
def test_patches_come_back(suffix: str, whole: PatchedMesh, tmp_path: Path) -> None:
    found = read(whole, suffix, tmp_path)
    expected = where(found.points)
    if suffix == "xdmf":
        for name, nodes in expected.items():
            assert np.flatnonzero(found.point_data[name]).tolist() == nodes.tolist()
        return
    if suffix == "inp":
        for name, nodes in expected.items():
            assert found.point_sets[name.upper()].tolist() == nodes.tolist()
        assert len(found.cell_sets["FLEXSPLINE"][0]) == len(whole.tetrahedra)
        return
    for name, cells in triangles(found, suffix, tmp_path).items():
        assert np.unique(cells).tolist() == expected[name].tolist()
        assert area(found.points, cells) == pytest.approx(AREAS[name], rel=BY_PARABOLAS)


@pytest.mark.parametrize("suffix", ["msh", "med"])
def test_the_body_is_a_group(suffix: str, whole: PatchedMesh, tmp_path: Path) -> None:
    number, tags = body_number(read(whole, suffix, tmp_path), suffix)
    assert (tags == number).all()


HALF_WRITTEN = """
import resource, sys
from pathlib import Path
from hand_made_tube import tube
from flexspline.results.mesh_files import PatchedMesh, write_mesh

mesh, path = PatchedMesh.of("flexspline", tube(30.0, 2)), Path(sys.argv[1])
write_mesh(mesh, path)
resource.setrlimit(resource.RLIMIT_FSIZE, (path.stat().st_size // 2,) * 2)
try:
    write_mesh(mesh, path)
except OSError:
    sys.exit(3)
"""


@pytest.mark.parametrize("suffix", EVERY)
def test_a_disk_full_halfway_is_an_error_or_seen_by_the_end_of_the_file(
    suffix: str, tmp_path: Path
) -> None:
    done = subprocess.run(
        [sys.executable, "-c", HALF_WRITTEN, str(tmp_path / f"flexspline.{suffix}")],
        capture_output=True, text=True, check=False, cwd=Path(__file__).parents[1] / "helpers",
    )  # fmt: skip
    said = done.returncode == 3
    assert said or f".{suffix}" in ENDINGS, "ENDINGS of results/export.py: how a whole file ends"


@pytest.mark.parametrize("scale", [1e-3, 0.98765432101, 123.456789012])
def test_long_negative_numbers_fit_into_nastrans_fields(
    scale: float, whole: PatchedMesh, tmp_path: Path
) -> None:
    scaled = replace(whole, points=whole.points * scale)
    found = read(scaled, "bdf", tmp_path)
    np.testing.assert_allclose(found.points, scaled.points, atol=1e-9 * scale)


def test_abaqus_elements_are_of_the_kind_that_calculix_knows(
    whole: PatchedMesh, tmp_path: Path
) -> None:
    write_mesh(whole, tmp_path / "flexspline.inp")
    text = (tmp_path / "flexspline.inp").read_text(encoding="ascii")
    assert re.findall(r"\*ELEMENT, TYPE=(.*)", text) == ["C3D10"]


def test_each_format_that_is_named_has_a_writer() -> None:
    assert tuple(WRITERS) == FORMATS


def test_formats_may_stand_in_one_word_or_in_several() -> None:
    assert chosen_formats(["msh,bdf", "msh", "inp"]) == ("msh", "bdf", "inp")


@pytest.mark.parametrize("page", ["README.md", "docs/meshes.md", "docs/contract.md", "--help"])
def test_every_format_is_named_where_users_look(page: str) -> None:
    if page == "--help":
        text = CliRunner().invoke(app, ["export", "--help"]).stdout
    else:
        text = (Path(__file__).parents[2] / page).read_text(encoding="utf-8")
    told = re.split(r"\W+", text.partition("--format")[2])
    assert [f for f in WRITERS if f not in told] == []


@pytest.mark.parametrize("word", ["stl", "step"])
def test_what_is_written_anyway_needs_no_format(word: str) -> None:
    with pytest.raises(
        DesignError,
        match="STEP and STL are always written; --format adds mesh files: one of msh",
    ):
        chosen_formats([word])


@pytest.mark.parametrize("word", ["obj", "", "msh,,bdf"])
def test_an_unknown_format_is_refused_with_those_that_work(word: str) -> None:
    with pytest.raises(DesignError, match=r"--format.*msh, med, bdf, inp, vtu, xdmf"):
        chosen_formats([word])


@pytest.mark.parametrize("name", ["med", "xdmf"])
def test_a_missing_library_is_named_with_the_extra(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flexspline.results.mesh_files.find_spec", lambda _: None)
    with pytest.raises(DesignError, match=r"needs h5py.*flexspline\[hdf5\]"):
        chosen_formats([name])


def test_all_formats_that_lack_it_are_named_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flexspline.results.mesh_files.find_spec", lambda _: None)
    with pytest.raises(DesignError, match=r'"med,xdmf".*need h5py'):
        chosen_formats(["msh,med,bdf,inp,vtu,xdmf"])
    assert chosen_formats(["msh,bdf"]) == ("msh", "bdf")


def test_the_readme_says_which_formats_need_more() -> None:
    text = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
    (row,) = (line for line in text.splitlines() if line.startswith("| `flexspline export"))
    assert "flexspline[hdf5]" in row


CASE = """*INCLUDE, INPUT=flexspline.inp
*MATERIAL, NAME=STEEL
*ELASTIC
206000., 0.3
*SOLID SECTION, ELSET=FLEXSPLINE, MATERIAL=STEEL
*TRANSFORM, NSET=MESH, TYPE=C
0., 0., 0., 0., 0., 1.
*STEP
*STATIC
*BOUNDARY
MOUNT, 1, 3
MESH, 1, 1
MESH, 2, 2, 0.01
MESH, 3, 3
*NODE PRINT, NSET=MESH, GLOBAL=NO
RF
*END STEP
"""


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX's ccx is not on this machine")
def test_calculix_twists_the_whole_part_as_we_do_its_sector(
    whole: PatchedMesh, tmp_path: Path
) -> None:
    write_mesh(whole, tmp_path / "flexspline.inp")
    (tmp_path / "case.inp").write_text(CASE, encoding="ascii")
    subprocess.run(["ccx", "-i", "case"], cwd=tmp_path, capture_output=True, check=True)
    rows = [
        line.split() for line in (tmp_path / "case.dat").read_text(encoding="ascii").splitlines()
    ]
    tangential = sum(float(row[2]) for row in rows if len(row) == 5 and row[0].isdigit())
    theirs = tangential * OUTER / (0.01 / OUTER) / NMM_PER_NM
    ours = torsion(Model.of(tube(30.0, 2), Elastic(206e3, 0.3)), "mesh").K_energy
    # C3D10 integrates with 4 points, we with 11: 1e-4 of K on elements that bend by 15°
    assert theirs == pytest.approx(ours, rel=1e-3)
