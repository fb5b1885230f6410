"""The cross-check deck: its structure as the format asks, and CalculiX's K against ours."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from pathlib import Path

import numpy as np
import pytest
from example_files import EXAMPLES
from structured import sector_mesh

from flexspline.fea.solid.deck import DECK_ANGLE_RAD, torsion_deck
from flexspline.fea.solid.defaults import first_spec
from flexspline.fea.solid.elements import NODES
from flexspline.fea.solid.load_cases import torsion
from flexspline.fea.solid.model import Model
from flexspline.fea.solid.swept import swept_mesh
from flexspline.fea.types import Elastic, TetMesh
from flexspline.geometry.load import load_design
from flexspline.geometry.symmetry import sector_of

CUP = EXAMPLES / "xb1-40.toml"
STEEL = Elastic(206e3, 0.3)


@dataclass(frozen=True)
class Deck:
    """A deck read back: keyword lines with their data lines, in order."""

    blocks: list[tuple[str, list[list[str]]]]

    @classmethod
    def read(cls, text: str) -> Deck:
        blocks: list[tuple[str, list[list[str]]]] = []
        for line in text.splitlines():
            if line.startswith("**"):
                continue
            if line.startswith("*"):
                blocks.append((line, []))
            else:
                blocks[-1][1].append([word.strip() for word in line.split(",")])
        return cls(blocks)

    def table(self, keyword: str) -> np.ndarray:
        (found,) = [rows for name, rows in self.blocks if name == keyword]
        return np.array(found, float)

    def node_set(self, name: str) -> set[int]:
        found = [rows for line, rows in self.blocks if line == f"*NSET, NSET={name}"]
        return {int(n) for rows in found for row in rows for n in row}

    def prescribed(self) -> dict[tuple[int, int], float]:
        """Value of every prescribed (node, component); fails where one is prescribed twice."""
        (rows,) = [rows for line, rows in self.blocks if line == "*BOUNDARY"]
        out: dict[tuple[int, int], float] = {}
        for target, first, last, *value in rows:
            for node in [int(target)] if target.isdigit() else self.node_set(target):
                for component in range(int(first), int(last) + 1):
                    assert (node, component) not in out
                    out[node, component] = float(value[0]) if value else 0.0
        return out


def tube(sector: float) -> TetMesh:
    return sector_mesh(
        np.linspace(8, 10, 3), np.linspace(0, sector, 4), np.linspace(0, 4, 3),
        {
            "mount": lambda c: np.isclose(c[:, 2], 0),
            "mesh": lambda c: np.isclose(c[:, 0], 10) & (c[:, 2] > 2),
        },
    )  # fmt: skip


def half_disc_with_axis_nodes() -> TetMesh:
    """A tube's half sector squeezed so that its inner surface lies on the axis at both planes."""
    mesh = tube(pi)
    nodes = mesh.nodes.copy()
    flat = np.abs(nodes[:, 1]) < 1e-9
    inner = flat & (np.abs(nodes[:, 0]) < 8.5)
    nodes[inner, :2] = 0.0
    return TetMesh(nodes, mesh.cells, mesh.facets, mesh.facet_patch, mesh.patches, 180.0)


def test_nodes_elements_and_patches_are_the_meshs() -> None:
    mesh = tube(pi / 6)
    deck = Deck.read(torsion_deck(mesh, STEEL, "mesh", 1.0, "tube"))
    nodes, elements = deck.table("*NODE, NSET=ALL"), deck.table("*ELEMENT, TYPE=C3D10, ELSET=PART")
    assert (nodes[:, 0] == np.arange(1, len(mesh.nodes) + 1)).all()
    assert nodes[:, 1:] == pytest.approx(mesh.nodes, abs=1e-10)  # 12 digits of 10 mm
    assert (elements[:, 1:] == mesh.cells + 1).all()
    for patch in filter(None, mesh.patches):
        assert deck.node_set(patch.upper()) == set((mesh.nodes_on(patch) + 1).tolist())
    assert deck.table("*ELASTIC").tolist() == [[206e3, 0.3]]


def test_nodes_5_to_10_lie_between_the_corners_that_c3d10_says() -> None:
    """CalculiX and Abaqus manuals: 5 on 1-2, 6 on 2-3, 7 on 3-1, 8 on 1-4, 9 on 2-4, 10 on 3-4."""
    pairs = np.array([[1, 2], [2, 3], [3, 1], [1, 4], [2, 4], [3, 4]]) - 1
    assert pytest.approx(NODES[4:]) == NODES[pairs].mean(axis=1)
    mesh = tube(0.01)  # so thin a sector that its edges are all but straight
    deck = Deck.read(torsion_deck(mesh, STEEL, "mesh", 1.0, "tube"))
    x = deck.table("*NODE, NSET=ALL")[:, 1:]
    e = deck.table("*ELEMENT, TYPE=C3D10, ELSET=PART")[:, 1:].astype(int) - 1
    # bending moves a middle by Δr·Δφ/4 = 0.0008 mm; half the shortest edge is 0.013 mm
    assert x[e[:, 4:]] == pytest.approx(x[e[:, pairs]].mean(axis=2), abs=2e-3)


def test_every_support_is_written_once() -> None:
    mesh = tube(pi / 6)
    deck = Deck.read(torsion_deck(mesh, STEEL, "mesh", 1.0, "tube"))
    given = deck.prescribed()
    radius = np.hypot(mesh.nodes[:, 0], mesh.nodes[:, 1])
    local = deck.node_set("CYLINDRICAL")
    for node in deck.node_set("MOUNT"):
        assert [given[node, c] for c in (1, 2, 3)] == [0, 0, 0]
    for node in deck.node_set("MESH") - deck.node_set("MOUNT"):
        assert node in local
        assert (given[node, 1], given[node, 3]) == (0, 0)
        assert given[node, 2] == pytest.approx(DECK_ANGLE_RAD * radius[node - 1], rel=1e-11)
    planes = deck.node_set("SYMMETRY_START") | deck.node_set("SYMMETRY_END")
    for node in planes - deck.node_set("MOUNT") - deck.node_set("MESH"):
        assert node in local
        assert (given[node, 1], given[node, 3]) == (0, 0)
        assert (node, 2) not in given
    assert len(given) == 3 * len(deck.node_set("HELD") | deck.node_set("TURNED")) + 2 * len(
        deck.node_set("ANTISYMMETRIC")
    )


def test_nodes_on_the_axis_have_no_cylindrical_axes() -> None:
    deck = Deck.read(torsion_deck(half_disc_with_axis_nodes(), STEEL, "mesh", 1.0, "half"))
    axis = deck.node_set("AXIS")
    assert axis
    assert not axis & deck.node_set("CYLINDRICAL")
    given = deck.prescribed()
    for node in axis:  # the one plane is y = 0: what lies in it vanishes, what is normal is free
        assert (given[node, 1], given[node, 3]) == (0, 0)
        assert (node, 2) not in given


def test_header_says_what_a_reader_needs() -> None:
    text = torsion_deck(tube(pi / 6), STEEL, "mesh", 31234.5, "* a\nname")
    header = text[: text.index("*NODE")]
    for words in ("mm, N, MPa", "30 degrees", "1/12", "0.001 rad", "12 * sum(r * RF2)", "31234.5"):
        assert words in header
    assert header.splitlines()[1] == "a name"
    assert all(len(line) <= 132 for line in text.splitlines())  # CalculiX's limit


def wedge(part: str) -> tuple[TetMesh, Elastic]:
    """Swept: the same mesh every time. The shaft has no holes: those of the cup take fewer elements."""
    design = load_design(CUP).changed({"shaft.bolt_count": 0})
    whole = design.part(part)
    mesh = swept_mesh(whole, sector_of(whole, "torsion").degrees, first_spec(whole))
    assert mesh is not None
    return mesh, Elastic.of(design.material.flexspline)


def stiffness_by_calculix(text: str, folder: Path) -> float:
    """K [N·m/rad] by the rule that the deck's header states."""
    (folder / "deck.inp").write_text(text, encoding="utf-8")
    done = subprocess.run(
        ["ccx", "-i", "deck"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout
    assert "*ERROR" not in done.stdout
    (copies,) = re.findall(r"K = (\d+) \* sum", text)
    nodes = Deck.read(text).table("*NODE, NSET=ALL")
    torque = 0.0
    for line in (folder / "deck.dat").read_text(encoding="utf-8").splitlines():
        words = line.split()
        if len(words) >= 4 and words[0].isdigit():
            x, y = nodes[int(words[0]) - 1, 1:3]
            torque += np.hypot(x, y) * float(words[2])
    return float(copies) * torque / (DECK_ANGLE_RAD * 1000)


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX's ccx is not on this machine")
@pytest.mark.parametrize(
    ("case", "tolerance"),
    [
        # two programs on one mesh; C3D10 integrates with 4 points, we with 11: on curved elements that is
        # 3e-6 of the cup and 1.7e-5 of the shaft, whose arcs are longer: with edges of 0.6 of that, 1.1e-5
        (lambda: wedge("flexspline"), 3e-5),
        (lambda: wedge("shaft"), 3e-5),
    ],
    ids=["cup", "shaft"],
)
def test_calculix_finds_our_stiffness(
    case: Callable[[], tuple[TetMesh, Elastic]], tolerance: float, tmp_path: Path
) -> None:
    mesh, material = case()
    driven = "mesh" if "mesh" in mesh.patches else "grip"
    ours = torsion(Model.of(mesh, material), driven).K_energy
    theirs = stiffness_by_calculix(torsion_deck(mesh, material, driven, ours, "wedge"), tmp_path)
    assert theirs == pytest.approx(ours, rel=tolerance)
